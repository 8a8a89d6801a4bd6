// One owner, one job at a time, and a rig that comes and goes.

#include "daemon/engine/engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <barrier>

#include "proc/core/number_text.h"
#include "proc/models/spec.h"
#include "tests/daemon/engine/engine_on_rig.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;
using test::Json;
using test::RunningEngine;
using test::waitUntil;
using test::Watcher;

TEST_F(EngineOnRig, JobRunsThenComputesThenTheRigIsIdle) {
    calibrate(folder.path());
    auto white = proc::makeModel("lambert,albedo=0.9");
    ASSERT_TRUE(white) << white.error().message;
    port.cable.device().place(
        {.role = sim::Role::Sample, .surface = std::move(*white), .wedge = {}});
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    EXPECT_EQ(engine->status().calibrations.size(), 2U);
    const int before = engine.aliveCalls();
    Watcher watcher(*engine);
    const std::uint64_t first = watcher.after() + 1;
    const auto id = submit(engine, {.kind = JobKind::VerifyWhite, .limit = 1});
    const auto events = watcher.until("job", {{"job", id}, {"state", "done"}});

    std::vector<std::string> told;  // progress once, however often
    int steps = 0;
    for (std::size_t i = 0; i < events.size(); ++i) {
        EXPECT_EQ(events[i].id, first + i) << "numbers have no gap";
        const Json data = Json::parse(events[i].data);
        if (events[i].type == "progress") {
            EXPECT_EQ(data["step"], ++steps);
            EXPECT_EQ(data["steps"], 13);  // one dark exposure, four LEDs of three bands
            EXPECT_EQ(data["job"], id);
            if (steps > 1) continue;
        }
        told.push_back(events[i].type +
                       (data.contains("state") ? " " + std::string(data["state"]) : std::string()));
    }
    const std::vector<std::string> order{
        "job running", "rig running", "progress", "rig finishing", "rig idle", "job done"};
    EXPECT_EQ(told, order);
    EXPECT_EQ(steps, 13);
    EXPECT_GE(engine.aliveCalls(), before + steps) << "the watchdog is fed at each step";

    EXPECT_FALSE(engine->status().job);
    const JobRecord job = kept(id);
    EXPECT_EQ(job.state, JobState::Done);
    EXPECT_FALSE(job.error);
    EXPECT_EQ(Json::parse(job.result)["schema"], "gonio/verify-white/1");
    EXPECT_TRUE(port.cable.wasLit());
    EXPECT_TRUE(waitUntil([&] { return !port.cable.lit(); }));
}

TEST_F(EngineOnRig, WhileAJobRunsEverythingElseIsBusy) {
    RunningEngine engine(folder.path(), port);
    const auto id = submitHeld(engine);
    const auto busy = [](const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::Busy);
        EXPECT_NE(error.message.find("calibrate-mirror"), std::string::npos) << error.message;
        EXPECT_NE(error.message.find("gonio jobs cancel"), std::string::npos) << error.message;
    };
    busy(engine->submit(kMirrorJob).error());
    busy(engine->openSession({.name = "one"}).error());
    busy(engine->closeSession().error());
    const EngineStatus now = engine->status();
    EXPECT_EQ(now.state, EngineState::Running);
    ASSERT_TRUE(now.job);
    EXPECT_EQ(now.job->record.id, id);
    EXPECT_EQ(kept(id).state, JobState::Running);
    port.cable.letGo();
}

TEST_F(EngineOnRig, OfJobsAskedForAtTheSameMomentOneRunsAndTheOthersAreToldAtOnce) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    port.cable.hold();
    constexpr int kThreads = 8;
    std::barrier together(kThreads);
    std::atomic<int> begun{0}, busy{0};
    {
        std::vector<std::jthread> clients;
        for (int i = 0; i < kThreads; ++i) {
            clients.emplace_back([&] {
                together.arrive_and_wait();
                const auto job = engine->submit(kMirrorJob);
                ++(job ? begun : busy);
                EXPECT_TRUE(job || job.error().kind == ErrorKind::Busy);
            });
        }
        // The job stands still: whoever waited for its end would wait here.
        EXPECT_TRUE(waitUntil([&] { return begun + busy == kThreads; }, 5s * test::kSlowdown));
        EXPECT_EQ(begun, 1);
        const auto running = engine->status().job;
        EXPECT_TRUE(running && engine->cancel(running->record.id));
        port.cable.letGo();
    }
    EXPECT_EQ(Logbook::open(folder.path())->jobs(100)->size(), 1U) << "none of them ran later";
}

TEST_F(EngineOnRig, CancelEndsTheJobAtItsNextStepAndTheLedsAreDark) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    ASSERT_TRUE(engine->cancel(id));
    const auto events = watcher.until("job", {{"job", id}, {"state", "cancelled"}});
    EXPECT_EQ(events[events.size() - 2].type, "rig");  // idle again
    EXPECT_TRUE(waitUntil([&] { return !port.cable.lit(); }));
    engine.await(EngineState::Idle);
    const JobRecord job = kept(id);
    EXPECT_EQ(job.state, JobState::Cancelled);
    ASSERT_TRUE(job.error);
    EXPECT_EQ(job.error->kind, ErrorKind::Interrupted);
    EXPECT_NE(job.endedUtc, "");
    EXPECT_EQ(engine->cancel(id).error().kind, ErrorKind::Usage) << "it no longer runs";
}

TEST_F(EngineOnRig, EndedInTheMiddleOfAJobItLeavesItInterruptedAndTheRigDark) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    const auto id = submit(engine);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    const auto begin = std::chrono::steady_clock::now();
    engine.end();
    // 3 s is what the daemon promises; a step of this job takes a tenth of that.
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 3s * test::kSlowdown);
    EXPECT_FALSE(port.cable.litInTheEnd());
    EXPECT_EQ(kept(id).state, JobState::Interrupted);
    EXPECT_TRUE(engine->events().closed());
    const auto refused = engine->submit(kMirrorJob);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Busy) << "the engine has ended";
}

TEST_F(EngineOnRig, JobThatRanWhenTheLastDaemonDiedIsInterruptedAndThatIsTold) {
    std::int64_t id = 0;
    {
        ASSERT_TRUE(Store::open(folder.path()));
        auto book = Logbook::open(folder.path());
        ASSERT_TRUE(book) << book.error().message;
        id = book->beginJob({.kind = "measure", .name = "tile", .startedUtc = "t"})->id;
    }
    RunningEngine engine(folder.path(), port);
    Watcher watcher(*engine, 0);
    const auto events = watcher.until("job", {{"job", id}, {"state", "interrupted"}});
    EXPECT_EQ(Json::parse(events.back().data)["name"], "tile");
    EXPECT_EQ(kept(id).state, JobState::Interrupted);
    EXPECT_EQ(kept(id).error->kind, ErrorKind::Interrupted);
    engine.await(EngineState::Idle);
    EXPECT_FALSE(engine->status().job) << "it is never run again by itself";
}

/// What a kill -9 at this moment would leave of a store.
void snapshot(const std::filesystem::path& store, const std::filesystem::path& to) {
    std::filesystem::copy(store, to, std::filesystem::copy_options::recursive);
}

TEST_F(EngineOnRig, NumbersOfEventsAscendAlsoAfterAKill) {
    const test::TempFolder after;
    RunningEngine engine(folder.path(), port);
    submitHeld(engine);  // the newest event, "running", is one that the logbook does not keep
    const std::uint64_t newest = engine->events().newest();
    snapshot(folder.path(), after / "store");
    port.cable.letGo();

    test::TestPort again;
    RunningEngine next(after / "store", again);
    Watcher watcher(*next, newest);  // as a client that comes back
    watcher.until("job", {{"state", "interrupted"}});
    EXPECT_GT(watcher.after(), newest);
}

TEST_F(EngineOnRig, PlanStepsAreNeverUsedTwiceAlsoAfterAKill) {
    const auto nextStep = [&] {
        return parseInteger(*Logbook::open(folder.path())->setting("plan-step/SIM-0001"));
    };
    RunningEngine engine(folder.path(), port);
    const auto id = submitHeld(engine);
    // Reserved before the first capture: a kill from here on leaves it at that.
    EXPECT_TRUE(waitUntil([&] { return nextStep() == 1 + 65536; }));
    Watcher watcher(*engine);
    port.cable.letGo();
    ASSERT_TRUE(engine->cancel(id));
    watcher.until("job", {{"job", id}});
    EXPECT_GE(nextStep(), 1);
    EXPECT_LT(nextStep(), 100) << "what was not used is given back";
}

TEST_F(EngineOnRig, RigLostInAJobInterruptsItAndIsClaimedAgainWithTheSameNumber) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    watcher.until("progress");
    port.cable.pull();
    watcher.until("rig", {{"state", "interrupted"}});
    watcher.until("job", {{"job", id}, {"state", "interrupted"}});
    const EngineStatus lost = engine->status();
    EXPECT_EQ(lost.state, EngineState::Offline) << "without a job it is merely not there";
    EXPECT_NE(lost.obstacle.find("cable was pulled"), std::string::npos) << lost.obstacle;
    EXPECT_FALSE(lost.rig);
    const auto refused = engine->submit(kMirrorJob);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::NoRig);
    EXPECT_EQ(kept(id).error->kind, ErrorKind::Device);

    port.cable.plug();
    engine.clock().turn(500ms);  // PROTOCOL.md 4: how often it is looked for
    engine.await(EngineState::Idle);
    EXPECT_EQ(engine->status().obstacle, "");
    const auto claims = port.cable.claims();
    ASSERT_GE(claims.size(), 2U);
    for (const std::uint64_t claim : claims) EXPECT_EQ(claim, claims.front());
    EXPECT_EQ(kept(id).state, JobState::Interrupted) << "it is never run again by itself";
}

TEST_F(EngineOnRig, ClaimNumberIsKeptOverARestart) {
    {
        RunningEngine engine(folder.path(), port);
        engine.await(EngineState::Idle);
    }
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    const auto claims = port.cable.claims();
    ASSERT_EQ(claims.size(), 2U);
    EXPECT_EQ(claims[0], claims[1]);
}

TEST_F(EngineOnRig, RigThatIsHeldByAnotherIsTriedAgainAfterTwoSeconds) {
    port.refuse(Error{ErrorKind::Busy, "held by another program"});
    RunningEngine engine(folder.path(), port);
    ASSERT_TRUE(engine.awaitTurns(3));
    EXPECT_EQ(port.opens(), 1);
    EXPECT_EQ(engine->status().state, EngineState::Offline);
    EXPECT_EQ(engine->status().obstacle, "held by another program");
    const auto refused = engine->submit(kMirrorJob);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Busy);
    EXPECT_NE(refused.error().message.find("held by another program"), std::string::npos);
    engine.clock().turn(1999ms);
    ASSERT_TRUE(engine.awaitTurns(2));
    EXPECT_EQ(port.opens(), 1);
    engine.clock().turn(1ms);
    ASSERT_TRUE(waitUntil([&] { return port.opens() == 2; }));
    port.refuse({});
    engine.clock().turn(2s);
    engine.await(EngineState::Idle);
    EXPECT_EQ(engine->status().obstacle, "");
}

TEST_F(EngineOnRig, RigThatIsNotThereIsLookedForEachHalfSecond) {
    port.cable.pull();
    RunningEngine engine(folder.path(), port);
    ASSERT_TRUE(waitUntil([&] { return port.opens() == 1; }));
    for (int looks = 2; looks < 4; ++looks) {
        engine.clock().turn(500ms);
        ASSERT_TRUE(waitUntil([&] { return port.opens() == looks; }));
    }
    port.cable.plug();
    engine.clock().turn(500ms);
    engine.await(EngineState::Idle);
}

TEST_F(EngineOnRig, RigThatGoesWhileIdleIsOfflineUntilItComesBack) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    port.cable.pull();
    engine.await(EngineState::Offline);
    port.cable.plug();
    // It looks every half second from its last look on, which may come after the first turn.
    EXPECT_TRUE(test::waitUntil([&] {
        engine.clock().turn(100ms);
        return engine->status().state == EngineState::Idle;
    }));
}

TEST_F(EngineOnRig, JobWaitsForAPersonAndGoesOnWhenItIsDone) {
    port.mirrorPlacesItself = false;
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    const EventRecord asked = watcher.until("operator").back();
    const Json first = Json::parse(asked.data);
    EXPECT_EQ(first["job"], id);
    EXPECT_EQ(first["question"], asked.id);
    EXPECT_NE(first["wanted"].get<std::string>().find("mirror"), std::string::npos) << first;
    ASSERT_TRUE(engine->status().job && engine->status().job->question);
    EXPECT_EQ(engine->status().job->question->wanted, first["wanted"]);
    EXPECT_EQ(engine->status().job->question->number, asked.id);
    EXPECT_EQ(engine->status().state, EngineState::Running);
    ASSERT_TRUE(engine.awaitTurns(2)) << "the watchdog is fed while it waits";

    EXPECT_EQ(engine->proceed(id + 1, asked.id).error().kind, ErrorKind::Usage);
    ASSERT_TRUE(engine->proceed(id, asked.id));
    const auto running = engine->status().job;
    ASSERT_TRUE(running);
    EXPECT_FALSE(running->question && running->question->number == asked.id) << "it is answered";
    const auto events = watcher.until("operator");  // the next wedge
    EXPECT_EQ(events.front().type, "progress");
    EXPECT_NE(Json::parse(events.back().data)["wanted"], first["wanted"]);
    const auto late = engine->proceed(id, asked.id);
    ASSERT_FALSE(late) << "that answered the question before";
    EXPECT_NE(late.error().message.find(std::to_string(events.back().id)), std::string::npos)
        << late.error().message;

    ASSERT_TRUE(engine->cancel(id));
    watcher.until("job", {{"job", id}, {"state", "cancelled"}});
    EXPECT_EQ(kept(id).state, JobState::Cancelled);
    EXPECT_EQ(engine->proceed(id, events.back().id).error().kind, ErrorKind::Usage)
        << "it waits for nobody";
}

TEST_F(EngineOnRig, AnswerThatComesWithTheQuestionIsNotLost) {
    port.mirrorPlacesItself = false;
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    // As quick as a client can be: it looks at the status and never waits for the event.
    ASSERT_TRUE(waitUntil([&] {
        const auto job = engine->status().job;
        return job && job->question && engine->proceed(id, job->question->number);
    }));
    watcher.until("progress", {{"step", 2}});
    ASSERT_TRUE(engine->cancel(id));
}

TEST_F(EngineOnRig, RigLostWhileAPersonIsAwaitedInterruptsTheJob) {
    port.mirrorPlacesItself = false;
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    watcher.until("operator");
    port.cable.pull();
    watcher.until("job", {{"job", id}, {"state", "interrupted"}});
    EXPECT_EQ(engine->status().state, EngineState::Offline);
}
TEST_F(EngineOnRig, OpenInterlockIsAFaultUntilItIsClosed) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    ASSERT_TRUE(waitUntil([&] { return port.cable.lit(); }));
    port.cable.setInterlock(0);
    watcher.until("job", {{"job", id}, {"state", "failed"}});
    EXPECT_EQ(kept(id).error->kind, ErrorKind::Device);
    engine.await(EngineState::Fault);
    const auto refused = engine->submit(kMirrorJob);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Device);
    EXPECT_NE(refused.error().message.find("seat it again"), std::string::npos)
        << refused.error().message;
    EXPECT_NE(engine->status().obstacle.find("INTERLOCK"), std::string::npos);
    port.cable.setInterlock(driver::interlock::kMayLight);
    engine.await(EngineState::Idle);
    EXPECT_EQ(engine->status().obstacle, "");
}

TEST_F(EngineOnRig, StoredSampleIsWorkedOutAgainWithoutARig) {
    port.cable.pull();
    RunningEngine engine(folder.path(), port);
    ASSERT_TRUE(waitUntil([&] { return !engine->status().obstacle.empty(); }));
    Watcher watcher(*engine);
    const auto id = submit(engine, {.kind = JobKind::Recalibrate, .name = "tile"});
    watcher.until("job", {{"job", id}, {"state", "failed"}});
    EXPECT_EQ(kept(id).error->kind, ErrorKind::File) << "there is no such sample";
    EXPECT_EQ(engine->status().state, EngineState::Offline);
}

TEST_F(EngineOnRig, LostRigIsNotTakenForTheReasonOfAJobThatNeedsNone) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    port.cable.pull();
    const auto id = submit(engine, {.kind = JobKind::Recalibrate, .name = "tile"});
    watcher.until("job", {{"job", id}, {"state", "failed"}});
    EXPECT_EQ(kept(id).error->kind, ErrorKind::File);
    engine.await(EngineState::Offline);
    const std::string obstacle = engine->status().obstacle;
    EXPECT_NE(obstacle, "");
    EXPECT_EQ(obstacle.find("tile"), std::string::npos) << obstacle;
}

TEST_F(EngineOnRig, ExceptionEndsTheJobAndNotTheDaemon) {
    port.failsToPlace = true;
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    watcher.until("job", {{"job", id}, {"state", "failed"}});
    EXPECT_EQ(kept(id).error->kind, ErrorKind::Internal);
    EXPECT_NE(kept(id).error->message.find("no place for the mirror"), std::string::npos);
    engine.await(EngineState::Idle);
    EXPECT_FALSE(port.cable.lit());
    port.failsToPlace = false;
    const auto again = submit(engine);
    watcher.until("progress", {{"job", again}, {"step", 2}});
    ASSERT_TRUE(engine->cancel(again));
}

TEST_F(EngineOnRig, PlacingUnderARealRigIsAUsageError) {
    RunningEngine engine(folder.path(), port);
    const auto refused = engine->place({.what = "white"});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
}

TEST_F(EngineOnRig, JobThatNoRigCanDoIsRefusedBeforeItIsKept) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    EXPECT_EQ(engine->submit({.name = "../x"}).error().kind, ErrorKind::Usage);
    EXPECT_TRUE(Logbook::open(folder.path())->jobs(10)->empty());
}

TEST_F(EngineOnRig, JobThatFailsSaysWhyAndLeavesTheRigIdle) {
    RunningEngine engine(folder.path(), port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine, {.name = "tile"});
    const auto events = watcher.until("job", {{"job", id}, {"state", "failed"}});
    const Json data = Json::parse(events.back().data);
    EXPECT_NE(data["message"].get<std::string>().find("gonio calibrate mirror"), std::string::npos);
    EXPECT_EQ(kept(id).error->kind, ErrorKind::Quality);
    engine.await(EngineState::Idle);
}

TEST_F(EngineOnRig, SessionIsToldAndStillOpenAfterARestart) {
    {
        RunningEngine engine(folder.path(), port);
        Watcher watcher(*engine);
        const auto opened = engine->openSession({.name = "one", .operatorName = "Ada"});
        ASSERT_TRUE(opened) << opened.error().message;
        EXPECT_EQ(opened->openedUtc, "2026-01-02T03:04:05Z");
        watcher.until("session", {{"name", "one"}, {"open", true}});
        EXPECT_EQ(engine->openSession({.name = "two"}).error().kind, ErrorKind::Usage);
    }
    RunningEngine engine(folder.path(), port);
    ASSERT_TRUE(engine->status().session);
    EXPECT_EQ(engine->status().session->operatorName, "Ada");
    Watcher watcher(*engine);
    ASSERT_TRUE(engine->closeSession());
    watcher.until("session", {{"name", "one"}, {"open", false}});
    EXPECT_FALSE(engine->status().session);
    EXPECT_EQ(engine->closeSession().error().kind, ErrorKind::Usage);
}

TEST_F(EngineOnRig, StoreHasOneOwner) {
    const RunningEngine engine(folder.path(), port);
    const test::TurnedClock clock;
    const auto second = Engine::open(folder.path(),
                                     port,
                                     test::quickProfile(),
                                     {.clock = clock,
                                      .utcNow = [] { return "t"; },
                                      .randomId = [] { return 1; },
                                      .alive = [] {}});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, ErrorKind::Busy);
}

TEST(EngineOnSim, PlacesWhatItIsToldAndAnotherRigIsClaimedAnew) {
    const test::TempFolder folder;
    auto port = SimPort::open(folder.path());
    ASSERT_TRUE(port) << port.error().message;
    RunningEngine engine(folder.path(), **port);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    ASSERT_TRUE(engine->place({.what = "mirror"}));
    watcher.until("placed", {{"what", "mirror"}});
    EXPECT_EQ(engine->status().placed, "mirror");
    EXPECT_EQ(engine->place({.what = "model:lambret"}).error().kind, ErrorKind::Usage);
    EXPECT_EQ(engine->status().placed, "mirror");

    const auto job = engine->submit(kMirrorJob);
    ASSERT_TRUE(job) << job.error().message;
    const auto busy = engine->place({.what = "white"});
    ASSERT_FALSE(busy);
    EXPECT_EQ(busy.error().kind, ErrorKind::Busy);
    ASSERT_TRUE(engine->cancel(job->id));
    watcher.until("job", {{"job", job->id}, {"state", "cancelled"}});

    ASSERT_TRUE(engine->place({.what = "white", .serial = "SIM-0002"}));
    EXPECT_EQ(engine->status().serial, "SIM-0002");
    EXPECT_EQ(engine->status().state, EngineState::Idle);
    watcher.until("rig", {{"state", "idle"}, {"serial", "SIM-0002"}});
}

}  // namespace
}  // namespace gonio::daemon
