#include "daemon/engine/monitor.h"

#include <nlohmann/json.hpp>

#include "daemon/engine/interruption_text.h"
#include "daemon/engine/plan_document.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto kPause = 250ms;  // between two looks at a rig that waits for a person

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

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
        alive();
        if (Result<void> there = engine_.rig_->keepAlive(); !there) return there;
        std::unique_lock lock(engine_.mutex_);
        engine_.asked_.wait_for(lock, kPause, [&] { return engine_.wish_ != Wish::None; });
        if (stop_.stop_requested() || engine_.wish_ == Wish::Cancel) {
            return cancelled();
        }
        if (engine_.wish_ == Wish::Proceed) {
            lock.unlock();
            put({});
            return {};
        }
    }
}

Result<void> Engine::Monitor::suspended(const Error& why) {
    driver::Interruption gap{.cause = why.message, .at = engine_.world_.clock.now()};
    if (Result<void> again = engine_.awaitLight(why); !again) return again;
    gap.lasted = engine_.world_.clock.now() - gap.at;
    keep(std::move(gap));
    return {};
}

void Engine::Monitor::setback(const Setback& setback) {
    engine_.tell("setback",
                 dump({{"job", engine_.status().job->record.id},
                       {"bracket", setback.bracket},
                       {"cause", std::string(name(setback.cause))},
                       {"message", setback.message}}),
                 true);
}

const std::vector<driver::Interruption>& Engine::Monitor::interruptions() {
    if (engine_.rig_)
        for (driver::Interruption& one : engine_.rig_->takeInterruptions()) keep(std::move(one));
    return interruptions_;
}

void Engine::Monitor::keep(driver::Interruption interruption) {
    Json event{{"job", engine_.status().job->record.id}};
    event.update(toJson(interruption));
    interruptions_.push_back(std::move(interruption));
    engine_.publish([&](EngineStatus& status) {
        status.job->interruptions = static_cast<int>(interruptions_.size());
    });
    engine_.tell("interruption", dump(event), true);
}

}  // namespace gonio::daemon
