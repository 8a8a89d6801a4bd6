// The doctor of a rig that a daemon has: what it asks of it, and when it leaves it alone.

#include <gtest/gtest.h>

#include <map>

#include "daemon/engine/recorded_port.h"
#include "daemon/engine/replay_port.h"
#include "tests/daemon/engine/engine_on_rig.h"

namespace gonio::daemon {
namespace {

using test::RunningEngine;
using test::waitUntil;

class EngineDoctor : public EngineOnRig {};

/// The doctor's findings of the engine's rig, by subject.
std::map<std::string, Finding> examined(RunningEngine& engine, bool handsOff = false) {
    const auto findings = engine->examine(handsOff);
    EXPECT_TRUE(findings) << findings.error().message;
    std::map<std::string, Finding> bySubject;
    if (!findings) return bySubject;
    EXPECT_EQ(findings->front().subject, "claim");
    for (const Finding& one : *findings) EXPECT_TRUE(bySubject.emplace(one.subject, one).second);
    return bySubject;
}

TEST_F(EngineDoctor, RigThatIsIdleIsExaminedAndTheJobsStepsAreLeft) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    const auto seen = examined(engine);
    ASSERT_EQ(seen.size(), 10U);
    for (const auto& [subject, finding] : seen)
        EXPECT_EQ(finding.verdict, Verdict::Ok) << subject << ": " << finding.seen;
    EXPECT_NE(seen.at("identity").seen.find("SIM-0001"), std::string::npos);
    EXPECT_NE(seen.at("self-test").seen.find("2 dark frames"), std::string::npos);
    EXPECT_FALSE(port.cable.wasLit());
    EXPECT_EQ(engine->status().state, EngineState::Idle);
    const auto step = Logbook::open(folder.path())->setting("plan-step/SIM-0001");
    ASSERT_TRUE(step);
    EXPECT_EQ(*step, "") << "none was given out";
    for (int again = 0; again < 2; ++again)
        EXPECT_EQ(examined(engine).at("self-test").verdict, Verdict::Ok);
}

TEST_F(EngineDoctor, RigInAJobIsNotAskedAndNotesSayWhy) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    ASSERT_TRUE(engine.awaitTurns(1));  // its state has been said
    const auto id = submitHeld(engine);
    const auto seen = examined(engine);  // though nothing moves on its cable
    for (const char* subject : {"clock", "self-test", "noise", "counters", "link"}) {
        EXPECT_EQ(seen.at(subject).verdict, Verdict::Note) << subject;
        EXPECT_NE(seen.at(subject).seen.find("calibrate-mirror"), std::string::npos)
            << seen.at(subject).seen;
    }
    EXPECT_EQ(seen.at("claim").seen, "goniod's, and running");
    EXPECT_EQ(seen.at("temperature").verdict, Verdict::Ok) << seen.at("temperature").seen;
    EXPECT_EQ(seen.at("interlock").verdict, Verdict::Ok);
    EXPECT_TRUE(engine->cancel(id));
    port.cable.letGo();
}

TEST_F(EngineDoctor, CoverThatIsOpenedWhileAJobWaitsForAPersonIsSaid) {
    port.mirrorPlacesItself = false;
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    test::Watcher watcher(*engine);
    const auto id = submit(engine);
    watcher.until("operator");
    EXPECT_EQ(examined(engine).at("interlock").verdict, Verdict::Ok);
    port.cable.setInterlock(driver::interlock::kSeated);
    EXPECT_TRUE(waitUntil([&] { return examined(engine).at("interlock").verdict != Verdict::Ok; }));
    EXPECT_EQ(engine->status().state, EngineState::Running);
    EXPECT_TRUE(engine->cancel(id));
}

TEST_F(EngineDoctor, RigThatIsLostWhileItIsExaminedIsAFailureAndNoLongerTheEngines) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    port.cable.pullAtDarkeningAfter(1);
    const auto seen = examined(engine);
    ASSERT_TRUE(port.cable.pulled());
    for (const char* subject : {"claim", "self-test", "link"}) {
        EXPECT_EQ(seen.at(subject).verdict, Verdict::Fail) << subject;
        EXPECT_NE(seen.at(subject).seen.find("the cable was pulled"), std::string::npos)
            << seen.at(subject).seen;
    }
    EXPECT_EQ(engine->status().state, EngineState::Offline);
}

TEST_F(EngineDoctor, RigThatMustNotBeLitIsTheEnginesWithAWarningThatSaysWhereToLook) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    test::Watcher watcher(*engine);
    const auto id = submit(engine);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.setInterlock(0);
    watcher.until("job", {{"job", id}, {"state", "failed"}});
    engine.await(EngineState::Fault);
    const auto seen = examined(engine, true);
    EXPECT_EQ(seen.at("claim").verdict, Verdict::Warn);
    EXPECT_NE(seen.at("claim").cure.find("see interlock"), std::string::npos);
    EXPECT_EQ(seen.at("interlock").verdict, Verdict::Fail);
}

TEST_F(EngineDoctor, HandsOffNothingIsAskedOfTheRig) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    ASSERT_TRUE(engine.awaitTurns(1));  // its state has been said
    port.cable.hold();
    const auto seen = examined(engine, true);
    EXPECT_EQ(seen.at("self-test").seen, "not looked at: not asked for");
    port.cable.letGo();
}

TEST_F(EngineDoctor, RigThatIsNotThereIsAFailureThatSaysWhy) {
    port.refuse(Error{ErrorKind::Busy, "the rig is held by other-program"});
    RunningEngine engine(folder.path(), port);
    ASSERT_TRUE(waitUntil([&] { return !engine->status().obstacle.empty(); }));
    const auto seen = examined(engine);
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_EQ(seen.at("claim").verdict, Verdict::Fail);
    EXPECT_NE(seen.at("claim").seen.find("held by other-program"), std::string::npos);
    EXPECT_NE(seen.at("claim").cure, "");
}

TEST_F(EngineDoctor, RecordedAndReplayedRigsAreAskedByJobsOnly) {
    const auto file = folder / "traffic";
    const auto expectLeft = [&](RigPort& rig, const std::string& why) {
        const test::TempFolder store;
        RunningEngine engine(store.path(), rig);
        engine.await(EngineState::Idle);
        ASSERT_TRUE(engine.awaitTurns(1));
        const auto seen = examined(engine);
        EXPECT_EQ(seen.at("self-test").verdict, Verdict::Note);
        EXPECT_NE(seen.at("self-test").seen.find(why), std::string::npos)
            << seen.at("self-test").seen;
    };
    {
        auto recorder = driver::Recorder::open(file);
        ASSERT_TRUE(recorder) << recorder.error().message;
        RecordedPort recorded(std::make_unique<test::TestPort>(), std::move(*recorder));
        expectLeft(recorded, "recorded");
    }
    auto replay = driver::Replay::open(file);
    ASSERT_TRUE(replay) << replay.error().message;
    ReplayPort replayed(std::move(*replay));
    expectLeft(replayed, "a recording");
}

}  // namespace
}  // namespace gonio::daemon
