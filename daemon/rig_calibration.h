#pragma once
// What is kept of a calibration: the lens map with the lens's glare (JSON) and the binned signals
// of the two references (a .gonio whose f holds the signal in electrons per second and steradian,
// u_random its standard deviation, u_systematic what its glare is unknown by). Their raw captures
// lie beside them, so that they can be binned again.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/optics/binning.h"
#include "proc/optics/glare.h"
#include "proc/optics/lens_fit.h"
#include "proc/table/sample_set.h"

namespace gonio::daemon {

/// The field that cells are measured in.
inline constexpr Radians kField = 75_deg;

struct LensRecord {
    proc::LensFit fit;
    int spots = 0;
    std::string dateUtc;
    /// Empty: not known, and not taken off.
    std::optional<proc::GlareSpread> glare{};
};

/// Takes off the lens's glare; nothing where it is not known.
[[nodiscard]] proc::GlareFilter glareFilterOf(const LensRecord& lens, const Window& window);

[[nodiscard]] std::string encodeLens(const LensRecord& lens);
/// `name` stands in errors.
[[nodiscard]] Result<LensRecord> decodeLens(std::string_view text, const std::string& name);
/// Signals of one placement: per LED, by ascending number, one per band.
using PlacementSignals = std::vector<std::array<proc::CellSignal, 3>>;

struct ReferenceRecord {
    proc::SampleInfo info;
    PlacementSignals signals;
};

[[nodiscard]] Result<std::string> encodeReference(const ReferenceRecord& reference,
                                                  const std::vector<Radians>& ledAngles);
/// `name` stands in errors.
[[nodiscard]] Result<ReferenceRecord> decodeReference(std::string_view bytes,
                                                      const std::string& name);

}  // namespace gonio::daemon
