#pragma once
// Which calibrations a sample is measured with, and whether they are good for it. A sample needs
// three of its rig: the lens map ("mirror"), black and white. Taken where they are there: the zero
// reference, the flat field, the LED monitor ("leds") and the sensor. They are named by their
// numbers in the store, "10+11+12" or "10+11+12+13+14" in this order; a sample carries that name,
// so that it can be worked out again. A reference that was seen with another lens map, flat field
// or LED monitor is binned again from its raw capture. The sensor's figures went into the merge of
// the frames, which are not kept: they are of the capture, and cannot be exchanged afterwards.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/measurement.h"
#include "daemon/profile.h"
#include "daemon/rig_calibration.h"
#include "daemon/rig_sweeps.h"
#include "daemon/store.h"

namespace gonio::daemon {

/// All kinds; a sample needs the first three.
inline constexpr std::array<std::string_view, 8> kCalibrationKinds{
    "mirror", "black", "white", "zero", "flat", "leds", "sensor", "dark"};

struct CalibrationSet {
    CalibrationRecord mirror, black, white;
    std::optional<CalibrationRecord> zero{}, flat{}, leds{}, sensor{};
    /// "10+11+12"; more where more is there.
    [[nodiscard]] std::string id() const;
};

/// The newest of the rig. Quality error that names the command to run where one of the three is
/// missing that a sample needs.
[[nodiscard]] Result<CalibrationSet> newestSet(Store& store, const std::string& rig);

/// The set of that name: numbers with + between them, of a mirror, a black, a white and what else
/// there is; or one number, which takes the place of its kind in `otherwise`. Usage error for what
/// is neither; Quality error for a calibration of another rig or kind, or one that is not there.
[[nodiscard]] Result<CalibrationSet> parseSet(Store& store,
                                              std::string_view text,
                                              const CalibrationSet& otherwise);

/// The newest of the rig and kind; Quality error that names the command to run.
[[nodiscard]] Result<CalibrationRecord> newestOf(Store& store,
                                                 const std::string& rig,
                                                 const std::string& kind);

/// How long before that date it was taken; empty where one of the dates cannot be read.
[[nodiscard]] std::optional<Seconds> ageAt(const CalibrationRecord& calibration,
                                           const std::string& dateUtc);

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

/// What a sample can do without is used where it is good, and left out with a warning where not.
void leaveOutStale(CalibrationSet& set, const RigNow& now, const ValidityLimits& limits);
/// The newest of that kind that is good now; empty, with a warning where there is one that is not.
[[nodiscard]] std::optional<CalibrationRecord> newestGood(Store& store,
                                                          const std::string& kind,
                                                          const RigNow& now,
                                                          const ValidityLimits& limits);

/// The rig as its newest good sensor calibration makes it; the plain profile without one. `now` has
/// the plain profile's hash.
[[nodiscard]] RigProfile measuredProfile(Store& store, const RigProfile& plain, const RigNow& now);

/// How a merged picture becomes signals.
struct View {
    LensRecord lens;
    Corrections corrections;
    std::string id;  ///< its calibrations' numbers: mirror, flat, leds; "10+13+14"
};
[[nodiscard]] Result<View> viewOf(const CalibrationRecord& mirror,
                                  const std::optional<CalibrationRecord>& flat,
                                  const std::optional<CalibrationRecord>& leds);
[[nodiscard]] Result<View> viewOf(const CalibrationSet& set);

[[nodiscard]] Result<LensRecord> readLens(const CalibrationRecord& mirror);
[[nodiscard]] Result<SensorRecord> readSensor(const CalibrationRecord& sensor);
/// Its signals as this view has them, all bands of each of its LEDs. File error where a state is
/// missing.
[[nodiscard]] Result<ReferenceRecord> readReference(Store& store,
                                                    const CalibrationRecord& reference,
                                                    const View& view);

struct LoadedSet {
    View view;
    ReferenceRecord black, white;
    std::optional<ReferenceRecord> zero;
};
[[nodiscard]] Result<LoadedSet> loadSet(Store& store, const CalibrationSet& set);
/// All borrowed.
[[nodiscard]] RigReferences referencesOf(const LoadedSet& loaded,
                                         const References& certified,
                                         const RigProfile& profile);

/// All signals of a raw capture as a view has them, by LED; LEDs that it lacks are left out.
[[nodiscard]] Result<PlacementSignals> binned(const std::filesystem::path& raw, const View& view);
/// File error unless there are `leds` LEDs, with all of their bands.
[[nodiscard]] Result<void> checkComplete(const PlacementSignals& signals,
                                         std::size_t leds,
                                         const std::string& what);

}  // namespace gonio::daemon
