#pragma once
// An engine with a thread that owns its rig, on a clock that the test turns.

#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/engine/engine.h"
#include "tests/support/wait_until.h"

namespace gonio::test {

using Json = nlohmann::json;

class TurnedClock : public Clock {
public:
    [[nodiscard]] Nanoseconds now() const override { return Nanoseconds(now_.load()); }
    void turn(Nanoseconds by) { now_ += by.count(); }

private:
    std::atomic<std::int64_t> now_{0};
};

/// The usual profile with one exposure: an eighth of the work, every step of the way.
inline daemon::RigProfile quickProfile() {
    auto profile = daemon::readProfile(daemon::defaultProfile());
    EXPECT_TRUE(profile) << profile.error().message;
    if (!profile) return {};
    profile->exposures.resize(1);
    return std::move(*profile);
}

class RunningEngine {
public:
    /// `patience`: how long a job waits for its rig.
    RunningEngine(const std::filesystem::path& store,
                  daemon::RigPort& port,
                  Seconds patience = Seconds(0)) {
        auto opened = daemon::Engine::open(store,
                                           port,
                                           quickProfile(),
                                           {.clock = clock_,
                                            .utcNow = [] { return "2026-01-02T03:04:05Z"; },
                                            .randomId = [this] { return 0x100000001U + ids_++; },
                                            .alive = [this] { ++alive_; },
                                            .patience = patience});
        EXPECT_TRUE(opened) << opened.error().message;
        if (!opened) return;
        engine_ = std::move(*opened);
        owner_ = std::jthread([this](const std::stop_token& stop) { engine_->run(stop); });
    }
    /// Ends the owner as the daemon does.
    void end() {
        owner_.request_stop();
        if (owner_.joinable()) owner_.join();
    }

    [[nodiscard]] daemon::Engine& operator*() const { return *engine_; }
    [[nodiscard]] daemon::Engine* operator->() const { return engine_.get(); }
    [[nodiscard]] TurnedClock& clock() { return clock_; }
    [[nodiscard]] int aliveCalls() const { return alive_; }

    /// Until the engine is in that state and has told so; fails the test when it does not come to
    /// that.
    void await(daemon::EngineState state) const {
        ASSERT_TRUE(waitUntil([&] {
            return engine_->status().state == state && toldLast() == name(state);
        })) << "wanted "
            << name(state) << ", is " << name(engine_->status().state);
    }
    /// The owner has gone round `turns` times from here.
    [[nodiscard]] bool awaitTurns(int turns) const {
        const int until = alive_ + turns + 1;
        return waitUntil([&] { return alive_ >= until; });
    }

private:
    [[nodiscard]] std::string toldLast() const {
        std::string state = "offline";
        for (const auto& event : engine_->events().after(0, std::chrono::milliseconds(0))) {
            if (event.type == "rig") state = Json::parse(event.data)["state"];
        }
        return state;
    }
    TurnedClock clock_;
    std::atomic<std::uint64_t> ids_{0};
    std::atomic<int> alive_{0};
    std::unique_ptr<daemon::Engine> engine_;
    std::jthread owner_;
};

/// Reads an engine's events one after the other.
class Watcher {
public:
    explicit Watcher(daemon::Engine& engine, std::uint64_t after)
        : engine_(&engine), after_(after) {}
    explicit Watcher(daemon::Engine& engine) : Watcher(engine, engine.events().newest()) {}

    /// All events up to the first of that type whose data hold all of `members`; a failed test when
    /// none comes.
    std::vector<daemon::EventRecord> until(const std::string& type, const Json& members = {}) {
        std::vector<daemon::EventRecord> seen;
        const bool found = waitUntil([&] {
            for (auto& event : engine_->events().after(after_, std::chrono::milliseconds(50))) {
                after_ = event.id;
                seen.push_back(event);
                if (event.type == type && holds(Json::parse(event.data), members)) return true;
            }
            return false;
        });
        EXPECT_TRUE(found) << "no event " << type << " " << members;
        return seen;
    }
    [[nodiscard]] std::uint64_t after() const { return after_; }

private:
    static bool holds(const Json& data, const Json& members) {
        for (const auto& [name, value] : members.items()) {
            if (!data.contains(name) || data[name] != value) return false;
        }
        return true;
    }
    daemon::Engine* engine_;
    std::uint64_t after_;
};

}  // namespace gonio::test
