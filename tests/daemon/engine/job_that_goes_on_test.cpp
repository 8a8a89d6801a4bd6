// Jobs whose rig goes away, or must not light, and comes back.

#include <utility>

#include "proc/models/spec.h"
#include "tests/daemon/engine/engine_on_rig.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;
using test::Json;
using test::RunningEngine;
using test::waitUntil;
using test::Watcher;

/// A check of the white on a rig that is calibrated for it.
class JobThatGoesOn : public EngineOnRig {
protected:
    void SetUp() override { ready(folder.path(), port); }
    static void ready(const std::filesystem::path& store, test::TestPort& port) {
        calibrate(store);
        auto white = proc::makeModel("lambert,albedo=0.9");
        ASSERT_TRUE(white) << white.error().message;
        port.cable.device().place(
            {.role = sim::Role::Sample, .surface = std::move(*white), .wedge = {}});
    }
    /// Its document, once it is done.
    Json documentOf(std::int64_t job) {
        EXPECT_EQ(kept(job).state, JobState::Done) << kept(job).error->message;
        return Json::parse(kept(job).result, nullptr, false);
    }
    /// Of a job that nothing has disturbed.
    static Json undisturbed() {
        const test::TempFolder folder;
        test::TestPort port;
        ready(folder.path(), port);
        RunningEngine engine(folder.path(), port);
        engine.await(EngineState::Idle);
        Watcher watcher(*engine);
        const auto job = engine->submit(kCheck);
        EXPECT_TRUE(job) << job.error().message;
        watcher.until("job", {{"state", "done"}});
        return Json::parse(Logbook::open(folder.path())->job(job->id)->result, nullptr, false);
    }
    static void expectSame(Json seen, Json wanted) {
        for (Json* one : {&seen, &wanted}) {
            one->erase("rig_seconds");
            one->erase("compute_seconds");
            one->erase("interruptions");
        }
        EXPECT_EQ(seen, wanted);
    }
    static int timesIn(const std::string& text, const std::string& part) {
        int times = 0;
        for (std::size_t at = text.find(part); at != std::string::npos; ++times)
            at = text.find(part, at + part.size());
        return times;
    }
    static inline const JobRequest kCheck{.kind = JobKind::VerifyWhite, .limit = 1};
};

TEST_F(JobThatGoesOn, RigThatComesBackInTimeIsTakenUpAndNothingIsLost) {
    RunningEngine engine(folder.path(), port, 600s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.pull();
    watcher.until("rig", {{"state", "interrupted"}});
    EXPECT_EQ(engine->status().state, EngineState::Interrupted);
    EXPECT_NE(engine->status().obstacle, "");
    ASSERT_TRUE(engine.awaitTurns(2)) << "the watchdog is fed while it waits";
    port.cable.plug();
    engine.clock().turn(500ms);
    watcher.until("rig", {{"state", "running"}});
    watcher.until("interruption", {{"job", id}, {"same_boot", true}});
    watcher.until("job", {{"job", id}, {"state", "done"}});
    const Json document = documentOf(id);
    ASSERT_EQ(document["interruptions"].size(), 1U) << document;
    EXPECT_NE(document["interruptions"][0]["cause"], "");
    expectSame(document, undisturbed());
    EXPECT_EQ(engine->status().obstacle, "");
}

TEST_F(JobThatGoesOn, RigThatIsGoneTooLongInterruptsTheJob) {
    RunningEngine engine(folder.path(), port, 5s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.pull();
    watcher.until("rig", {{"state", "interrupted"}});
    engine.clock().turn(6s);
    watcher.until("job", {{"job", id}, {"state", "interrupted"}});
    EXPECT_NE(kept(id).error->message.find("waited 5 s"), std::string::npos)
        << kept(id).error->message;
    port.cable.plug();
    EXPECT_TRUE(waitUntil([&] {
        engine.clock().turn(100ms);
        return engine->status().state == EngineState::Idle;
    }));
}

TEST_F(JobThatGoesOn, JobThatWaitsForItsRigCanBeCancelled) {
    RunningEngine engine(folder.path(), port, 600s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.pull();
    watcher.until("rig", {{"state", "interrupted"}});
    ASSERT_TRUE(engine->cancel(id));
    watcher.until("job", {{"job", id}, {"state", "cancelled"}});
    EXPECT_NE(kept(id).error->message.find("cancelled"), std::string::npos);
    const EngineStatus after = engine->status();
    EXPECT_EQ(after.state, EngineState::Offline) << "without a job the rig is merely not there";
    EXPECT_NE(after.obstacle.find("the cable was pulled"), std::string::npos) << after.obstacle;
    EXPECT_EQ(after.obstacle.find("cancelled"), std::string::npos) << after.obstacle;
}

TEST_F(JobThatGoesOn, RigThatCannotBeOpenedYetIsTriedAgain) {
    RunningEngine engine(folder.path(), port, 600s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.refuse(Error{ErrorKind::Busy, "rig SIM-0001: no permission yet"});
    port.cable.pull();
    watcher.until("rig", {{"state", "interrupted"}});
    port.cable.plug();
    EXPECT_TRUE(waitUntil([&] {
        engine.clock().turn(500ms);
        return engine->status().obstacle.find("no permission") != std::string::npos;
    }));
    port.refuse({});
    engine.clock().turn(500ms);
    watcher.until("job", {{"job", id}, {"state", "done"}});
}

TEST_F(JobThatGoesOn, OpenInterlockSuspendsTheJobUntilItIsClosedAgain) {
    testing::internal::CaptureStderr();
    RunningEngine engine(folder.path(), port, 600s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.setInterlock(0);
    watcher.until("rig", {{"state", "suspended"}});
    EXPECT_NE(engine->status().obstacle.find("seat it again"), std::string::npos)
        << engine->status().obstacle;
    ASSERT_TRUE(engine.awaitTurns(2)) << "the watchdog is fed while it waits";
    EXPECT_EQ(engine->status().state, EngineState::Suspended);
    port.cable.setInterlock(driver::interlock::kMayLight);
    watcher.until("rig", {{"state", "running"}});
    watcher.until("setback", {{"cause", "suspended"}});
    watcher.until("job", {{"job", id}, {"state", "done"}});
    EXPECT_EQ(timesIn(testing::internal::GetCapturedStderr(), "seat it again"), 1);
    const Json document = documentOf(id);
    EXPECT_EQ(document["interruptions"].size(), 1U);
    expectSame(document, undisturbed());
    EXPECT_EQ(engine->status().obstacle, "");
}

TEST_F(JobThatGoesOn, SuspendedJobCanBeCancelledAndTheFaultIsLeft) {
    RunningEngine engine(folder.path(), port, 600s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.setInterlock(0);
    watcher.until("rig", {{"state", "suspended"}});
    ASSERT_TRUE(engine->cancel(id));
    watcher.until("job", {{"job", id}, {"state", "cancelled"}});
    engine.await(EngineState::Fault);
    EXPECT_FALSE(port.cable.lit());
}

TEST_F(JobThatGoesOn, RigThatRefusedToGoDarkAfterTheLastFrameIsDarkAllTheSame) {
    RunningEngine engine(folder.path(), port, 60s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    port.cable.refuseDarkeningAfter(2);  // the second is lit, and so are all others
    const auto id = submit(engine, kCheck);
    watcher.until("job", {{"job", id}, {"state", "done"}});
    ASSERT_TRUE(port.cable.hasRefused());
    EXPECT_TRUE(waitUntil([&] { return !port.cable.lit(); }));
    engine.end();
    EXPECT_FALSE(port.cable.litInTheEnd());
}

TEST_F(JobThatGoesOn, RigLostAfterTheLastFrameIsNotWaitedFor) {
    RunningEngine engine(folder.path(), port, 60s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    port.cable.pullAtDarkeningAfter(2);  // the second is lit, and so are all others
    const auto id = submit(engine, kCheck);
    for (const auto& event : watcher.until("job", {{"job", id}, {"state", "done"}}))
        EXPECT_EQ(event.data.find("\"interrupted\""), std::string::npos) << event.data;
    ASSERT_TRUE(port.cable.pulled());
    expectSame(documentOf(id), undisturbed());
    engine.await(EngineState::Offline);
}

/// A job that asks a person for something, on a rig whose cable is bumped meanwhile.
class JobThatAsks : public JobThatGoesOn {
protected:
    JobThatAsks() { port.mirrorPlacesItself = false; }
    void bump(RunningEngine& engine, Watcher& watcher) {
        port.cable.pull();
        watcher.until("rig", {{"state", "interrupted"}});
        port.cable.plug();
        engine.clock().turn(500ms);
        watcher.until("rig", {{"state", "running"}});
        ASSERT_TRUE(engine.awaitTurns(4));
    }
};

TEST_F(JobThatAsks, EachGapHasItsOwnTime) {
    RunningEngine engine(folder.path(), port, 60s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    watcher.until("operator");
    bump(engine, watcher);
    engine.clock().turn(70s);  // the person takes a while
    ASSERT_TRUE(engine.awaitTurns(4));
    port.cable.pull();
    watcher.until("rig", {{"state", "interrupted"}});
    engine.clock().turn(50s);
    ASSERT_TRUE(engine.awaitTurns(2));
    EXPECT_EQ(engine->status().state, EngineState::Interrupted);
    engine.clock().turn(11s);
    watcher.until("job", {{"job", id}, {"state", "interrupted"}});
    EXPECT_NE(kept(id).error->message.find("waited 60 s"), std::string::npos)
        << kept(id).error->message;
}

TEST_F(JobThatAsks, GapIsBookedOnTheJobThatSurvivedItHoweverThatEnds) {
    RunningEngine engine(folder.path(), port, 60s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    watcher.until("operator");
    bump(engine, watcher);
    ASSERT_TRUE(engine->cancel(id));
    watcher.until("interruption", {{"job", id}, {"same_boot", true}});
    watcher.until("job", {{"job", id}, {"state", "cancelled"}});
    engine.await(EngineState::Idle);
    const auto next = submit(engine);
    for (const auto& event : watcher.until("operator", {{"job", next}}))
        EXPECT_NE(event.type, "interruption") << event.data;
    EXPECT_EQ(engine->status().job->interruptions, 0);
}

// The cable of the simulated rig, by a script: rule after rule, to one and the same rig.
TEST_F(JobThatGoesOn, SimulatedRigComesBackAsItsScriptSays) {
    auto sim = SimPort::open(folder.path());
    ASSERT_TRUE(sim) << sim.error().message;
    ASSERT_TRUE((*sim)->place({.what = "white"}));
    auto script = sim::FaultScript::parse(
        "on frame 3 unplug for 1s\n"
        "on frame 8 lose power for 1s\n"
        "on frame 62 plug as OTHER-1 for 1s\n");
    ASSERT_TRUE(script) << script.error().message;
    (*sim)->play(std::move(*script));
    RunningEngine engine(folder.path(), **sim, 600s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    bool refused = false;
    ASSERT_TRUE(waitUntil([&] {
        engine.clock().turn(50ms);
        const EngineStatus now = engine->status();
        refused = refused || (now.obstacle.find("SIM-0001") != std::string::npos &&
                              now.obstacle.find("OTHER-1") != std::string::npos);
        return !now.job;
    }));
    EXPECT_TRUE(refused) << "both are named";
    std::vector<bool> sameBoot;
    int redone = 0;
    for (const EventRecord& event : watcher.until("job", {{"job", id}, {"state", "done"}})) {
        const Json data = Json::parse(event.data);
        if (event.type == "interruption") {
            sameBoot.push_back(data["same_boot"]);
            EXPECT_GE(data["lasted_s"], 1.0) << data;
            EXPECT_LE(data["lasted_s"], 2.0) << data;
        }
        if (event.type == "setback") {
            EXPECT_EQ(data["cause"], "new-boot");
            ++redone;
        }
    }
    EXPECT_EQ(sameBoot, (std::vector<bool>{true, false, true}));
    EXPECT_EQ(redone, 1);
    EXPECT_EQ(documentOf(id)["interruptions"].size(), 3U);
}

TEST_F(JobThatGoesOn, RigThatIsThereAndCannotBeClaimedIsWaitedForAsOneThatIsGone) {
    RunningEngine engine(folder.path(), port, 550s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.pull();
    watcher.until("rig", {{"state", "interrupted"}});
    port.cable.mute(true);
    port.cable.plug();
    const std::uint64_t told = engine->events().newest();
    const int opened = port.opens();
    for (int looks = 0; looks < 5; ++looks) {
        engine.clock().turn(500ms);
        ASSERT_TRUE(waitUntil([&] { return port.opens() > opened + looks; }));
    }
    EXPECT_EQ(engine->status().state, EngineState::Interrupted);
    EXPECT_EQ(engine->events().newest(), told) << "nothing has changed";
    engine.clock().turn(550s);
    watcher.until("job", {{"job", id}, {"state", "interrupted"}});
    EXPECT_NE(kept(id).error->message.find("waited 550 s"), std::string::npos)
        << kept(id).error->message;
}

TEST_F(JobThatGoesOn, RigThatCanBeClaimedAtLastGoesOn) {
    RunningEngine engine(folder.path(), port, 600s);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, kCheck);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.pull();
    watcher.until("rig", {{"state", "interrupted"}});
    port.cable.mute(true);
    port.cable.plug();
    const int opened = port.opens();
    engine.clock().turn(500ms);
    ASSERT_TRUE(waitUntil([&] { return port.opens() > opened; }));
    EXPECT_TRUE(waitUntil([&] {
        return engine->status().obstacle.find("does not answer") != std::string::npos;
    })) << engine->status().obstacle;
    port.cable.mute(false);
    engine.clock().turn(500ms);
    watcher.until("rig", {{"state", "running"}});
    watcher.until("job", {{"job", id}, {"state", "done"}});
    EXPECT_EQ(documentOf(id)["interruptions"].size(), 1U);
}

}  // namespace
}  // namespace gonio::daemon
