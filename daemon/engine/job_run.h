#pragma once
// One run of one job: what all kinds of jobs need of their bench, and how long it took.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/alongside.h"
#include "daemon/calibrations.h"
#include "daemon/engine/job.h"
#include "daemon/measurement.h"

namespace gonio::daemon {

class JobRun {
public:
    /// Both are borrowed.
    JobRun(const JobBench& bench, const JobRequest& request);

    [[nodiscard]] const JobBench& bench() const { return bench_; }
    [[nodiscard]] const JobRequest& request() const { return request_; }
    [[nodiscard]] const std::string& serial() const { return serial_; }
    /// The rig's, with its sensor as it was measured last.
    [[nodiscard]] const RigProfile& profile() const { return profile_; }
    [[nodiscard]] std::size_t leds() const { return ledAngles().size(); }
    [[nodiscard]] const std::vector<Radians>& ledAngles() const { return ledAngles_; }
    [[nodiscard]] Seconds onRig() const { return onRig_.elapsed(); }

    [[nodiscard]] Bench measuring() const { return measuring(profile_); }
    /// By other figures than the run goes by; borrowed.
    [[nodiscard]] Bench measuring(const RigProfile& profile) const;
    /// What `work` answers, which takes long; rig and watchdog are fed meanwhile.
    template <class Work>
    auto whileAlive(Work work) const {
        return alongside(
            bench_.rig, [this] { bench_.monitor.alive(); }, std::move(work));
    }
    /// What every file of this job says of its origin.
    [[nodiscard]] proc::SampleInfo info(const std::string& name) const;
    /// And of how it was captured.
    void finish(proc::SampleInfo& info, const Captured& captured) const;

    /// Quality error unless this reference lies there, as far as the rig's door tells.
    [[nodiscard]] Result<void> expectPlaced(const std::string& reference) const;
    /// What the rig knows of itself now.
    [[nodiscard]] RigNow now() const;
    /// Of the LED board, and of the sensor; empty: the rig does not tell.
    [[nodiscard]] std::optional<double> celsius() const;
    [[nodiscard]] std::optional<double> sensorCelsius() const;
    /// The newest of that kind that is good now, if there is one.
    [[nodiscard]] std::optional<CalibrationRecord> newestGood(const std::string& kind) const;
    /// Into the store, as of this rig and of now, unless `record` says otherwise.
    [[nodiscard]] Result<CalibrationRecord> keep(CalibrationRecord record,
                                                 const Contents& contents) const;
    /// A reference is of this rig's LEDs, or its cells would be taken for others'.
    [[nodiscard]] Result<void> fitsThisRig(const ReferenceRecord& reference) const;

private:
    const JobBench& bench_;
    const JobRequest& request_;
    std::string serial_;
    std::vector<Radians> ledAngles_;
    Stopwatch onRig_;
    RigProfile profile_;
};

/// As `.graw`, with what the set says of itself and of its rotation.
[[nodiscard]] Result<std::string> rawBytes(const proc::SampleSet& set,
                                           std::vector<proc::RawState> states);

}  // namespace gonio::daemon
