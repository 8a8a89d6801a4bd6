#pragma once
// What a store knows of one rig (rigs/SERIAL/): its lens map (lens.json) and the binned signals of
// the two references (black.gonio, white.gonio: f holds the signal in electrons per second and
// steradian, u_random its standard deviation). Their raw captures lie beside them, so that they can
// be binned again.

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "proc/core/result.h"
#include "proc/optics/binning.h"
#include "proc/optics/lens_fit.h"
#include "proc/table/sample_set.h"

namespace gonio::daemon {

/// The field that cells are measured in.
inline constexpr Radians kField = 75_deg;

struct LensRecord {
    proc::LensFit fit;
    int spots = 0;
    std::string dateUtc;
};

Result<void> writeLens(const std::filesystem::path& folder, const LensRecord& lens);
/// Quality error that names the command to run when there is none.
[[nodiscard]] Result<LensRecord> readLens(const std::filesystem::path& folder);

/// Signals of one placement: per LED, by ascending number, one per band.
using PlacementSignals = std::vector<std::array<proc::CellSignal, 3>>;

/// `name` is "black" or "white".
Result<void> writeSignals(const std::filesystem::path& folder,
                          const std::string& name,
                          const proc::SampleInfo& info,
                          const std::vector<Radians>& ledAngles,
                          const PlacementSignals& signals);

struct ReferenceRecord {
    proc::SampleInfo info;
    PlacementSignals signals;
};
/// Quality error that names the command to run when there is none.
[[nodiscard]] Result<ReferenceRecord> readSignals(const std::filesystem::path& folder,
                                                  const std::string& name);

}  // namespace gonio::daemon
