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

}  // namespace
}  // namespace gonio::daemon
