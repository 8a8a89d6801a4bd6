// The engine's jobs: how one runs, is followed and ended, and what becomes of it.

#include "daemon/alongside.h"
#include "daemon/engine/engine.h"
#include "daemon/engine/monitor.h"
#include "daemon/guarded.h"
#include "driver/replay.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

constexpr std::uint64_t kReservedSteps = 1 << 16;  // no job takes more captures

}  // namespace

/// The first of the plan steps that are the next job's alone, however this one ends. From a
/// recording come those of the recorded job, whatever this store has counted.
Result<std::uint64_t> Engine::reserveSteps() {
    const driver::Replay* replay = port_.replay();
    if (const auto recorded = replay ? replay->nextPlanStep() : std::nullopt) return *recorded;
    const std::string key = "plan-step/" + status().serial;
    const Result<std::string> kept = logbook_.setting(key);
    if (!kept) return kept.error();
    const auto first = static_cast<std::uint64_t>(parseInteger(*kept).value_or(1));
    const auto set = logbook_.set(key, std::to_string(first + kReservedSteps));
    if (!set) return set.error();
    return first;
}

Result<std::string> Engine::runOn(const JobRequest& request, Monitor& monitor) {
    Result<std::uint64_t> step = reserveSteps();
    if (!step) return step.error();
    const EngineStatus now = status();
    const JobBench bench{.rig = *rig_,
                         .port = port_,
                         .store = store_,
                         .profile = profile_,
                         .computer = world_.clock,
                         .nextPlanStep = *step,
                         .session = now.session ? now.session->name : "",
                         .utcNow = world_.utcNow,
                         .monitor = monitor};
    Result<std::string> outcome =
        guarded("job " + std::string(name(request.kind)), [&] { return runJob(bench, request); });
    if (port_.replay() == nullptr) {
        const auto returned = logbook_.set("plan-step/" + now.serial, std::to_string(*step));
        if (!returned) log::warning(returned.error().message);
    }
    return outcome;
}

/// A job that needs no rig; one that is there is kept alive meanwhile.
Result<std::string> Engine::runAtDesk(const JobRequest& request, Monitor& monitor) {
    const Desk desk{
        .store = store_, .profile = profile_, .utcNow = world_.utcNow, .goOn = [&monitor] {
            return monitor.goOn();
        }};
    const auto work = [&] { return recalibrate(desk, request); };
    if (!rig_) return guarded("recalibrate", work);
    return alongside(
        *rig_, [&monitor] { monitor.alive(); }, work);
}

/// How it ended.
void Engine::settle(JobRecord& job, const Result<std::string>& outcome, const Monitor& monitor) {
    job.endedUtc = world_.utcNow();
    if (outcome) {
        job.state = JobState::Done;
        job.result = *outcome;
        return;
    }
    job.error = outcome.error();
    job.state = monitor.verdict();
}

/// After a job on it: it may be the reason of one that did not succeed. What it says of itself
/// afterwards is of after the job, also for tend(), which looks whether it is dark.
void Engine::lookAfterRig(JobRecord& job) {
    if (!rig_) return;
    const bool done = job.state == JobState::Done;
    if (!done) {
        const auto dark = rig_->darken();
        if (!dark && !rig_->link().lost()) log::warning(dark.error().message);
    }
    const auto there = rig_->status();
    if (there || done) return;
    if (job.state == JobState::Failed) job.state = JobState::Interrupted;
    lost(there.error());
}

void Engine::runPending(const std::stop_token& stop) {
    if (!pending_) return;
    Pending job = std::move(*pending_);
    pending_.reset();
    const std::string what = titleOf(job.record);
    log::info("job " + std::to_string(job.record.id) + ": " + what);
    advance(EngineEvent::JobBegun);
    Monitor monitor(*this, stop, what);
    lostAt_.reset();
    const bool atDesk = job.request.kind == JobKind::Recalibrate;
    if (!atDesk) monitor_ = &monitor;
    const Result<std::string> outcome =
        atDesk ? runAtDesk(job.request, monitor) : runOn(job.request, monitor);
    (void)monitor.interruptions();  // this job's, however it ended
    monitor_ = nullptr;
    settle(job.record, outcome, monitor);
    if (!atDesk) lookAfterRig(job.record);
    if (job.record.error) log::warning(job.record.error->message);
    if (Result<void> kept = logbook_.endJob(job.record); !kept) log::error(kept.error().message);
    publishCalibrations();
    {
        const std::scoped_lock lock(mutex_);
        status_.job.reset();
    }
    advance(EngineEvent::JobEnded);
    tellJob(job.record);
}

}  // namespace gonio::daemon
