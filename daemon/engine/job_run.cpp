#include "daemon/engine/job_run.h"

#include "daemon/engine/interruption_text.h"
#include "daemon/sample_quality.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_degrees.h"

namespace gonio::daemon {

JobRun::JobRun(const JobBench& bench, const JobRequest& request)
    : bench_(bench),
      request_(request),
      serial_(bench.rig.identify().serial),
      ledAngles_(bench.rig.identify().ledAngles),
      onRig_(bench.rig.link().clock()),
      profile_(bench.profile) {
    profile_ = measuredProfile(bench.store, bench.profile, now());
}

Bench JobRun::measuring(const RigProfile& profile) const {
    return {.rig = bench_.rig,
            .profile = profile,
            .nextPlanStep = bench_.nextPlanStep,
            .clock = bench_.computer,
            .step = [this](const std::string& what) { return bench_.monitor.step(what); },
            .attendance = {.alive = [this] { bench_.monitor.alive(); },
                           .suspended =
                               [this](const Error& why) { return bench_.monitor.suspended(why); },
                           .setback = [this](const Setback& one) { bench_.monitor.setback(one); },
                           .captured = [this] { bench_.monitor.captured(); }},
            .outlook = [this](const proc::Progress& now) { bench_.monitor.outlook(now); }};
}

proc::SampleInfo JobRun::info(const std::string& name) const {
    proc::SampleInfo info;
    info.name = name;
    info.rigSerial = serial_;
    info.profileHash = profile_.hash;
    noteLimits(profile_.quality, info);
    info.session = bench_.session;
    info.dateUtc = bench_.utcNow();
    info.softwareVersion = "gonio " GONIO_VERSION;
    info.operatorNotes = request_.notes;
    bench_.port.describe(info);
    return info;
}

void JobRun::finish(proc::SampleInfo& info, const Captured& captured) const {
    info.rigSeconds = onRig_.elapsed().count();
    info.computeSeconds = captured.compute.count();
    info.extra["chi_square_per_freedom"] = shortest(captured.chiSquarePerFreedom);
    const auto& interruptions = bench_.monitor.interruptions();
    info.interruptions = static_cast<int>(interruptions.size());
    if (!interruptions.empty()) info.extra["interrupted_by"] = described(interruptions);
    const std::string steps = described(captured.lightSteps);
    info.extra["light"] = steps.empty() ? "steady within each bracket" : steps;
}

Result<void> JobRun::expectPlaced(const std::string& reference) const {
    const std::string placed = bench_.port.placed();
    if (placed.empty() || placed == reference) return {};
    return Error{ErrorKind::Quality,
                 "under the rig lies '" + placed + "'; place the " + reference +
                     " first: gonio sim place " + reference};
}

std::optional<double> JobRun::celsius() const {
    const auto& status = bench_.rig.link().status();
    return status ? driver::celsius(status->temperature[0]) : std::nullopt;
}

std::optional<double> JobRun::sensorCelsius() const {
    const auto& status = bench_.rig.link().status();
    return status ? driver::celsius(status->temperature[1]) : std::nullopt;
}

RigNow JobRun::now() const {
    return {.serial = serial_,
            .profileHash = profile_.hash,
            .celsius = celsius(),
            .dateUtc = bench_.utcNow()};
}

std::optional<CalibrationRecord> JobRun::newestGood(const std::string& kind) const {
    return daemon::newestGood(bench_.store, kind, now(), profile_.validity);
}

Result<CalibrationRecord> JobRun::keep(CalibrationRecord record, const Contents& contents) const {
    record.rig = serial_;
    if (record.dateUtc.empty()) record.dateUtc = bench_.utcNow();
    if (record.profileHash.empty()) record.profileHash = profile_.hash;
    return bench_.store.addCalibration(std::move(record), contents);
}

Result<void> JobRun::fitsThisRig(const ReferenceRecord& reference) const {
    if (reference.signals.size() == leds()) return {};
    const std::string& kind = reference.info.name;
    return Error{ErrorKind::Quality,
                 "the " + kind + " reference of " + serial_ + " has " +
                     std::to_string(reference.signals.size()) + " LEDs, the rig " +
                     std::to_string(leds()) + "; run: gonio calibrate " + kind};
}

Result<std::string> rawBytes(const proc::SampleSet& set, std::vector<proc::RawState> states) {
    const proc::SampleInfo& info = set.info;
    std::map<std::string, std::string> about{{"name", info.name},
                                             {"rig_serial", info.rigSerial},
                                             {"profile_hash", info.profileHash},
                                             {"date", info.dateUtc},
                                             {"software", info.softwareVersion}};
    const double turned = set.leds.empty() ? 0 : proc::fileDegrees(set.leds.front().rotation);
    if (turned != 0) about["rotation_deg"] = shortest(turned);
    return proc::encodeGraw({.info = std::move(about), .states = std::move(states)});
}

}  // namespace gonio::daemon
