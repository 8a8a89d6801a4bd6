#pragma once
// What a rig can be asked to do: the references, the check of the white one, a sample's BRDF. A job
// is checked before it starts, says its steps, can be ended at each of them, and leaves a document.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/attendance.h"
#include "daemon/capture_goal.h"
#include "daemon/engine/rig_port.h"
#include "daemon/profile.h"
#include "daemon/store.h"
#include "driver/rig.h"
#include "proc/core/stopwatch.h"
#include "proc/plan/progress.h"
#include "proc/quality/translucency.h"

namespace gonio::daemon {

enum class JobKind {
    CalibrateMirror,
    CalibrateBlack,
    CalibrateWhite,
    CalibrateZero,
    CalibrateFlat,
    CalibrateSensor,
    CalibrateLeds,
    CalibrateDark,
    VerifyWhite,
    Measure,
    Plan,        ///< what measuring would take and achieve: pilots only
    Recalibrate  ///< of a stored sample: needs no rig
};
[[nodiscard]] std::string_view name(JobKind kind);
/// "calibrate-mirror", ..., "recalibrate"; anything else is a Usage error that lists them.
[[nodiscard]] Result<JobKind> parseJobKind(std::string_view text);

/// As tables keep it (proc/table/rotations.h); a Usage error unless it is -360 to 360 degrees.
[[nodiscard]] Result<Radians> parseRotation(double degrees);

struct JobRequest {
    JobKind kind = JobKind::Measure;
    std::string name;         ///< of the sample to measure or recalibrate; empty for the others
    CaptureGoal goal{};       ///< measure and plan
    std::string notes;        ///< the operator's, kept with the sample
    double limit = 0.01;      ///< verify-white: the largest relative change that passes
    bool turned = false;      ///< verify-white: the tile lies turned about its normal
    bool force = false;       ///< measure: with calibrations that are no longer good, too
    std::string calibration;  ///< recalibrate: which (calibrations.h); empty: the newest
    std::optional<proc::Backing>
        backing{};          ///< measure: what lies under the sample; empty: not said
    int monteCarlo = 0;     ///< measure, recalibrate: draws per cell; 0: where first order is wrong
    std::string against{};  ///< measure: the same sample on the other backing; empty: none
    Radians rotation{};     ///< measure: of the sample on the stage (proc/table/rotations.h)
};
/// Usage error for what no rig can do.
[[nodiscard]] Result<void> check(const JobRequest& request);

/// Who follows a job.
class JobMonitor {
public:
    virtual ~JobMonitor() = default;
    /// So many in all, those that are done among them.
    virtual void begin(int steps) = 0;
    /// What a measurement will take and achieve.
    virtual void planned(const proc::Plan& plan) = 0;
    /// How it stands against its plan, from the next step on.
    virtual void outlook(const proc::Progress& progress) = 0;
    /// One step is done. An error that it returns ends the job.
    virtual Result<void> step(const std::string& what) = 0;
    /// A person has to do something; returns once it is done. An error ends the job.
    virtual Result<void> ask(const std::string& what) = 0;
    /// All frames are there; what is left is computing.
    virtual void captured() = 0;
    /// It goes on: every few seconds at least, between two steps.
    virtual void alive() = 0;
    /// The rig does not light; returns once it may again. An error ends the job.
    virtual Result<void> suspended(const Error& why) = 0;
    virtual void setback(const Setback& setback) = 0;
    /// What has interrupted the job so far, and was survived.
    [[nodiscard]] virtual const std::vector<driver::Interruption>& interruptions() = 0;
};

/// What a job works with; all borrowed.
struct JobBench {
    driver::Rig& rig;
    RigPort& port;
    Store& store;
    const RigProfile& profile;
    const Clock& computer;
    std::uint64_t& nextPlanStep;
    std::string session;  ///< name; empty: none is open
    std::function<std::string()> utcNow;
    JobMonitor& monitor;
};

/// The document that came of it: JSON, schema gonio/calibrate-mirror/1, ..., gonio/measure/1.
[[nodiscard]] Result<std::string> runJob(const JobBench& bench, const JobRequest& request);

/// What working a stored sample out again needs; all borrowed.
struct Desk {
    Store& store;
    const RigProfile& profile;
    std::function<std::string()> utcNow;
    /// Asked before anything is kept, perhaps on a thread of its own. An error ends the job.
    std::function<Result<void>()> goOn = [] { return Result<void>(); };
};
/// Applies a calibration to the raw capture of a stored sample. With the one that it was measured
/// with the same bytes come out, and nothing is kept; else the sample of that name is the new one,
/// and the earlier is kept. Document of schema gonio/recalibrate/1.
[[nodiscard]] Result<std::string> recalibrate(const Desk& desk, const JobRequest& request);

}  // namespace gonio::daemon
