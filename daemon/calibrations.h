#pragma once
// Which calibrations a sample is measured with, and whether they are good for it. A sample needs
// three of its rig: the lens map ("mirror"), black and white; a fourth, the zero reference, is
// taken where there is one. They are named by their numbers in the store, "10+11+12" or
// "10+11+12+13" in this order; a sample carries that name, so that it can be worked out again. A
// reference that was binned with another lens map is binned again from its raw capture.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/measurement.h"
#include "daemon/profile.h"
#include "daemon/rig_calibration.h"
#include "daemon/store.h"

namespace gonio::daemon {

struct CalibrationSet {
    CalibrationRecord mirror, black, white;
    std::optional<CalibrationRecord> zero{};
    /// "10+11+12"; with a zero reference "10+11+12+13".
    [[nodiscard]] std::string id() const;
};

/// The newest of the rig. Quality error that names the command to run where one is missing, the
/// zero reference excepted.
[[nodiscard]] Result<CalibrationSet> newestSet(Store& store, const std::string& rig);

/// The set of that name: "10+11+12" (without a zero reference), "10+11+12+13", or one number, which
/// takes the place of its kind in `otherwise`. Usage error for what is neither; Quality error for a
/// calibration of another rig or kind, or one that is not there.
[[nodiscard]] Result<CalibrationSet> parseSet(Store& store,
                                              std::string_view text,
                                              const CalibrationSet& otherwise);

/// The newest of the rig and kind; Quality error that names the command to run.
[[nodiscard]] Result<CalibrationRecord> newestOf(Store& store,
                                                 const std::string& rig,
                                                 const std::string& kind);

/// The rig as it is now.
struct RigNow {
    std::string serial;
    std::string profileHash;
    std::optional<double> celsius;  ///< of the LED board
    std::string dateUtc;            ///< ISO 8601
};
/// Why a calibration is not good now, and what to run; empty: it is. One that is dated more than
/// five minutes from now is not: a clock is wrong, and its age is not known.
[[nodiscard]] std::string whyNot(const CalibrationRecord& calibration,
                                 const RigNow& now,
                                 const ValidityLimits& limits);

/// A zero reference is used where it is good: one that is not is left out, with a warning.
void leaveOutStaleZero(CalibrationSet& set, const RigNow& now, const ValidityLimits& limits);

[[nodiscard]] Result<LensRecord> readLens(const CalibrationRecord& mirror);
/// Its signals as this lens map bins them, all bands of each of its LEDs. `mirror` and `lens` are
/// one calibration. File error where a state is missing.
[[nodiscard]] Result<ReferenceRecord> readReference(Store& store,
                                                    const CalibrationRecord& reference,
                                                    const CalibrationRecord& mirror,
                                                    const LensRecord& lens);

struct LoadedSet {
    LensRecord lens;
    ReferenceRecord black, white;
    std::optional<ReferenceRecord> zero;
};
[[nodiscard]] Result<LoadedSet> loadSet(Store& store, const CalibrationSet& set);
/// All borrowed.
[[nodiscard]] RigReferences referencesOf(const LoadedSet& loaded,
                                         const References& certified,
                                         const RigProfile& profile);

/// All signals of a raw capture as a lens map bins them, by LED; LEDs that it lacks are left out.
[[nodiscard]] Result<PlacementSignals> binned(const std::filesystem::path& raw,
                                              const LensRecord& lens);
/// File error unless there are `leds` LEDs, with all of their bands.
[[nodiscard]] Result<void> checkComplete(const PlacementSignals& signals,
                                         std::size_t leds,
                                         const std::string& what);

}  // namespace gonio::daemon
