#pragma once
// Whole measurements on an opened rig: the mirror's lens map, a reference's signals, a sample's f;
// how a sample is captured by a plan is planned_run.h's. Frames are added up as they arrive, and
// merged and binned state by state beside the captures of the next. The result is that of merging
// one after the other. However a measurement ends, the LEDs are dark and no thread is left.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "daemon/corrections.h"
#include "daemon/frame_watch.h"
#include "daemon/light_watch.h"
#include "daemon/profile.h"
#include "daemon/references.h"
#include "daemon/rig_calibration.h"
#include "daemon/sequencer.h"
#include "driver/rig.h"
#include "proc/calibrate/two_point.h"
#include "proc/formats/graw_exr.h"
#include "proc/optics/mirror.h"
#include "proc/plan/progress.h"

namespace gonio::daemon {

/// What a measurement needs of its surroundings; all borrowed.
struct Bench {
    driver::Rig& rig;
    const RigProfile& profile;
    std::uint64_t& nextPlanStep;
    const Clock& clock;  ///< of the computer, for compute seconds
    /// One step of progress is done; an error that it returns ends the measurement.
    std::function<Result<void>(const std::string&)> step;
    Attendance attendance{};
    /// How a planned run stands against its plan, after each state.
    std::function<void(const proc::Progress&)> outlook = [](const proc::Progress&) {};
    /// The lens's glare, which signals are put right by; empty: none is taken off.
    std::optional<proc::GlareSpread> glare{};
    /// What else they are put right by.
    Corrections corrections{};
    /// A dark library of the sensor's temperature (stored_darks.h); empty: there is none.
    std::vector<proc::DarkFrame> darks{};
};

/// The window that is read: the square in the middle of the sensor.
[[nodiscard]] Result<Window> configureWindow(driver::Rig& rig);

/// Steps of progress that each measurement reports.
[[nodiscard]] int mirrorSteps(const Bench& bench);
[[nodiscard]] int placementSteps(const Bench& bench);

/// The operator, or the simulated rig's own door: puts the mirror on a wedge.
using PlaceMirror = std::function<Result<void>(const proc::Wedge&)>;
[[nodiscard]] Result<LensRecord> measureLens(const Bench& bench, const PlaceMirror& place);

/// The first exposures of a capture, and the same one once more at its end.
struct Repeat {
    State state;
    proc::CellSignal first, last;
};

/// All states of what lies under the rig.
struct Captured {
    PlacementSignals signals;
    proc::RawCapture raw;
    std::vector<LightStep> lightSteps;  ///< in the order of the states
    std::vector<OddFrame> oddFrames;    ///< as they came
    double chiSquarePerFreedom = 0;     ///< of all merges; 1 where noise alone differs
    Seconds compute{0};            ///< of merging and binning, though the rig went on meanwhile
    proc::DarkLibrary darks;       ///< that were subtracted
    proc::DarkLibrary freshDarks;  ///< taken over the sample: light that leaks in is in these
    std::optional<Repeat> repeat;  ///< empty where none was taken
};
[[nodiscard]] Result<Captured> measurePlacement(const Bench& bench,
                                                const proc::LensMap& lens,
                                                const BracketPlan& plan,
                                                int darkFrames);

/// Quality error when white is not far brighter than black.
[[nodiscard]] Result<void> checkWhite(const PlacementSignals& white, const PlacementSignals& black);
/// Quality error when the zero reference is not darker than black.
[[nodiscard]] Result<void> checkZero(const PlacementSignals& zero, const PlacementSignals& black);

/// Signals -> f, with the budget of each state as JSON in `info.budgetJson` and the achieved
/// uncertainty (median, k = 1, relative) in `info`.
struct RigReferences {
    const LensRecord& lens;
    const ReferenceRecord& white;
    const ReferenceRecord& black;
    const References& certified;
    const RigProfile& profile;
    const ReferenceRecord* zero = nullptr;  ///< null: there is none, and black stands for it
    /// What the LED monitor leaves of the light unknown between two captures, relative, by band.
    std::array<double, 3> uMonitor{};
};
/// What a state is held against: white, and zero or black.
[[nodiscard]] proc::References referencesOf(const RigReferences& references, State state);
/// With the tilt of the sample found, and corrected where that is sound (sample_pose.h); cells then
/// are known against the lobes (proc/quality/seen_direction.h), not against the lens map alone.
[[nodiscard]] proc::SampleSet calibrateSample(const PlacementSignals& signals,
                                              const std::vector<Radians>& ledAngles,
                                              const RigReferences& references,
                                              proc::SampleInfo info,
                                              const proc::MonteCarlo& monteCarlo = {});

/// A sample says how many draws its uncertainties were asked to be made of, so that it can be
/// worked out again alike.
void noteDraws(int draws, proc::SampleInfo& info);
[[nodiscard]] proc::MonteCarlo drawsOf(const proc::SampleInfo& info);

}  // namespace gonio::daemon
