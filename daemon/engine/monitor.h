#pragma once
// Who follows the job at hand for the engine: tells everyone how it goes on, and the job when it
// has to end.

#include <algorithm>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/engine/engine.h"

namespace gonio::daemon {

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
        alive();
        (void)interruptions();
        engine_.tellRecordingEnd();
        tell(what);
        return goOn();
    }
    /// Whether the job may, or has to end.
    Result<void> goOn() {
        if (!wished()) return {};
        return cancelled();
    }
    Result<void> ask(const std::string& what) override;
    void captured() override {
        captured_ = true;
        engine_.advance(EngineEvent::Captured);
    }
    void alive() override {
        engine_.world_.alive();
        engine_.publishRig();
    }
    Result<void> suspended(const Error& why) override;
    void setback(const Setback& setback) override;
    [[nodiscard]] const std::vector<driver::Interruption>& interruptions() override;

    /// Whether there are frames to be taken yet: only then the job waits for a rig that was lost.
    [[nodiscard]] bool needsRig() const { return !captured_; }
    [[nodiscard]] const std::string& job() const { return job_; }

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

    Error cancelled() {
        ended_ = true;
        return {ErrorKind::Interrupted, job_ + ": cancelled"};
    }
    void keep(driver::Interruption interruption);

    Engine& engine_;
    const std::stop_token& stop_;
    std::string job_;
    Stopwatch watch_;
    bool ended_ = false;
    std::optional<proc::Progress> outlook_;
    std::vector<driver::Interruption> interruptions_;
    bool captured_ = false;  ///< what is left needs no rig
};

}  // namespace gonio::daemon
