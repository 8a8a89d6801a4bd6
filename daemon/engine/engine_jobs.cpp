// The engine's jobs: how one runs, is followed and ended, and what becomes of it.

#include <nlohmann/json.hpp>

#include "daemon/alongside.h"
#include "daemon/engine/engine.h"
#include "daemon/engine/plan_document.h"
#include "daemon/guarded.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto kPause = 250ms;  // between two looks at a rig that waits for a person
constexpr std::uint64_t kReservedSteps = 1 << 16;  // no job takes more captures

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Error cancelled(const std::string& job) { return {ErrorKind::Interrupted, job + ": cancelled"}; }

}  // namespace

/// Tells everyone how the job at hand goes on, and the job when it has to end.
class Engine::Monitor : public JobMonitor {
public:
    Monitor(Engine& engine, const std::stop_token& stop, std::string job)
        : engine_(engine), stop_(stop), job_(std::move(job)), watch_(engine.world_.clock) {}

    void begin(int steps) override {
        engine_.publish([&](EngineStatus& status) { status.job->steps = steps; });
    }
    void planned(const proc::Plan& plan) override;
    void outlook(const proc::Progress& progress) override { outlook_ = progress; }
    Result<void> step(const std::string& what) override {
        engine_.world_.alive();
        tell(what);
        return goOn();
    }
    /// Whether the job may, or has to end.
    Result<void> goOn() {
        if (!wished()) return {};
        ended_ = true;
        return cancelled(job_);
    }
    Result<void> ask(const std::string& what) override;
    void captured() override { engine_.advance(EngineEvent::Captured); }
    void alive() override { engine_.world_.alive(); }

    /// How a job that did not succeed has ended.
    [[nodiscard]] JobState verdict() const {
        if (!ended_) return JobState::Failed;
        return stop_.stop_requested() ? JobState::Interrupted : JobState::Cancelled;
    }

private:
    void tell(const std::string& what);
    [[nodiscard]] bool wished() const {
        const std::scoped_lock lock(engine_.mutex_);
        return stop_.stop_requested() || engine_.wish_ == Wish::Cancel;
    }
    /// An answer counts from the moment on at which the question can be seen.
    std::int64_t put(std::optional<Question> question) {
        const std::scoped_lock lock(engine_.mutex_);
        if (engine_.wish_ == Wish::Proceed) engine_.wish_ = Wish::None;
        engine_.status_.job->question = std::move(question);
        return engine_.status_.job->record.id;
    }

    Engine& engine_;
    const std::stop_token& stop_;
    std::string job_;
    Stopwatch watch_;
    bool ended_ = false;
    std::optional<proc::Progress> outlook_;
};

void Engine::Monitor::tell(const std::string& what) {
    JobStatus now;
    engine_.publish([&](EngineStatus& status) {
        JobStatus& job = *status.job;
        job.step = std::min(job.step + 1, job.steps);
        job.what = what;
        job.elapsed = watch_.elapsed();
        job.left = outlook_ ? outlook_->remaining
                            : job.elapsed * (job.steps - job.step) / std::max(1, job.step);
        now = job;
    });
    Json progress{{"job", now.record.id},
                  {"step", now.step},
                  {"steps", now.steps},
                  {"what", what},
                  {"elapsed_s", now.elapsed.count()},
                  {"left_s", now.left->count()}};
    if (outlook_) progress["achieved"] = toJson(outlook_->achieved);
    engine_.tell("progress", dump(progress), false);
}

void Engine::Monitor::planned(const proc::Plan& plan) {
    Json event{{"job", engine_.status().job->record.id}};
    event.update(promiseOf(plan));
    engine_.tell("plan", dump(event), false);
}

Result<void> Engine::Monitor::ask(const std::string& what) {
    const std::uint64_t number = engine_.events_.newest() + 1;  // the owner alone adds
    const std::int64_t job = put(Question{number, what});
    engine_.tell("operator", dump({{"job", job}, {"question", number}, {"wanted", what}}), true);
    while (true) {
        engine_.world_.alive();
        if (Result<void> there = engine_.rig_->keepAlive(); !there) return there;
        std::unique_lock lock(engine_.mutex_);
        engine_.asked_.wait_for(lock, kPause, [&] { return engine_.wish_ != Wish::None; });
        if (stop_.stop_requested() || engine_.wish_ == Wish::Cancel) {
            ended_ = true;
            return cancelled(job_);
        }
        if (engine_.wish_ == Wish::Proceed) {
            lock.unlock();
            put({});
            return {};
        }
    }
}

/// The first of the plan steps that are the next job's alone, however this one ends.
Result<std::uint64_t> Engine::reserveSteps() {
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
    const auto returned = logbook_.set("plan-step/" + now.serial, std::to_string(*step));
    if (!returned) log::warning(returned.error().message);
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
        *rig_, [this] { world_.alive(); }, work);
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

/// After a job on it that did not succeed: it may be the reason.
void Engine::lookAfterRig(JobRecord& job, const Error& why) {
    if (!rig_) return;
    if (const auto there = rig_->status(); !there) {
        job.state = JobState::Interrupted;
        lost(why);
    } else if (const auto dark = rig_->darken(); !dark) {
        log::warning(dark.error().message);
    }
}

void Engine::runPending(const std::stop_token& stop) {
    if (!pending_) return;
    Pending job = std::move(*pending_);
    pending_.reset();
    const std::string what = titleOf(job.record);
    log::info("job " + std::to_string(job.record.id) + ": " + what);
    advance(EngineEvent::JobBegun);
    Monitor monitor(*this, stop, what);
    const bool atDesk = job.request.kind == JobKind::Recalibrate;
    const Result<std::string> outcome =
        atDesk ? runAtDesk(job.request, monitor) : runOn(job.request, monitor);
    settle(job.record, outcome, monitor);
    if (!atDesk && !outcome) lookAfterRig(job.record, outcome.error());
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
