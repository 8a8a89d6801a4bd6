// Jobs of which all traffic is recorded, and the recording in the rig's place.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include "daemon/engine/recorded_port.h"
#include "daemon/engine/replay_port.h"
#include "proc/models/spec.h"
#include "tests/daemon/engine/engine_on_rig.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;
using test::Json;
using test::RunningEngine;
using test::waitUntil;
using test::Watcher;

class RecordedJob : public EngineOnRig {};

const JobRequest kWhiteCheck{.kind = JobKind::VerifyWhite, .limit = 1};

/// A job by an engine of its own on `rig`, in a store that has counted so many plan steps. It would
/// wait ten minutes for its rig, by a clock that stands.
JobRecord jobOn(RigPort& rig, const JobRequest& request = kWhiteCheck, int steps = 0) {
    const test::TempFolder store;
    calibrate(store.path());
    if (steps > 0) {
        auto used = Logbook::open(store.path());
        EXPECT_TRUE(used->set("plan-step/SIM-0001", std::to_string(steps)));
    }
    RunningEngine engine(store.path(), rig, 600s);
    engine.await(EngineState::Idle);
    const auto job = engine->submit(request);
    EXPECT_TRUE(job) << job.error().message;
    EXPECT_TRUE(waitUntil([&] { return !engine->status().job; })) << engine->status().obstacle;
    engine.end();
    auto book = Logbook::open(store.path());
    const auto found = book->job(job ? job->id : 0);
    return found ? *found : JobRecord{};
}

Json verdictOf(const JobRecord& job) {
    EXPECT_EQ(job.state, JobState::Done) << (job.error ? job.error->message : "");
    return Json::parse(job.result, nullptr, false);
}

/// A check of the white, recorded.
JobRecord recordedJob(const std::filesystem::path& file, int steps = 0) {
    auto real = std::make_unique<test::TestPort>();
    real->cable.device().place({.role = sim::Role::Sample,
                                .surface = std::move(*proc::makeModel("lambert,albedo=0.9")),
                                .wedge = {}});
    auto recorder = driver::Recorder::open(file);
    EXPECT_TRUE(recorder) << recorder.error().message;
    RecordedPort recorded(std::move(real), std::move(*recorder));
    return jobOn(recorded, kWhiteCheck, steps);
}

std::unique_ptr<ReplayPort> replayOf(const std::filesystem::path& file) {
    auto replay = driver::Replay::open(file);
    EXPECT_TRUE(replay) << replay.error().message;
    return replay ? std::make_unique<ReplayPort>(std::move(*replay)) : nullptr;
}

TEST_F(RecordedJob, RecordingOfAUsedStoreGivesTheSameVerdictInAnotherAndSoDoesARecordingOfThat) {
    const Json seen = verdictOf(recordedJob(folder / "first", 5 * 65536));
    EXPECT_EQ(seen["schema"], "gonio/verify-white/1");
    {
        auto recorder = driver::Recorder::open(folder / "second");
        ASSERT_TRUE(recorder) << recorder.error().message;
        RecordedPort again(replayOf(folder / "first"), std::move(*recorder));
        EXPECT_EQ(again.list()->front().serial, "SIM-0001");
        EXPECT_EQ(verdictOf(jobOn(again)), seen);
    }
    EXPECT_EQ(verdictOf(jobOn(*replayOf(folder / "second"), kWhiteCheck, 77)), seen);
}

TEST_F(RecordedJob, ReplayThatTheJobLeavesEndsItAtOnceWithTheFirstDifference) {
    (void)recordedJob(folder / "traffic");
    const auto replayed = replayOf(folder / "traffic");
    const JobRecord other = jobOn(*replayed, {.kind = JobKind::CalibrateDark});
    ASSERT_TRUE(other.error) << name(other.state);
    EXPECT_EQ(other.state, JobState::Interrupted);
    EXPECT_NE(other.error->message.find("replay: record "), std::string::npos);
    EXPECT_NE(other.error->message.find("wanted: write "), std::string::npos);
    EXPECT_NE(other.error->message.find("same jobs in the same order"), std::string::npos);
    const auto after = replayed->open();
    ASSERT_FALSE(after);
    EXPECT_NE(other.error->message.find(after.error().message), std::string::npos)
        << "no opening is used up after it: " << after.error().message;
}

TEST_F(RecordedJob, ReplayThatIsOverEndsTheJobAtOnce) {
    const auto file = folder / "traffic";
    (void)recordedJob(file);
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    ASSERT_TRUE(driver::Recorder::open(file)) << "what is torn is cut off";
    const JobRecord job = jobOn(*replayOf(file));
    ASSERT_TRUE(job.error) << name(job.state);
    EXPECT_EQ(job.state, JobState::Interrupted);
    EXPECT_NE(job.error->message.find("here the recording of this opening ends"), std::string::npos)
        << job.error->message;
}

TEST_F(RecordedJob, RecordingThatMayNotGrowEndsWithAnEventAndTheJobGoesOn) {
    ::signal(SIGXFSZ, SIG_IGN);
    constexpr rlim_t kBytes = 1U << 20;  // of a file: less than the first frames, more than the log
    const rlimit limit{.rlim_cur = kBytes, .rlim_max = RLIM_INFINITY};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    auto recorder = driver::Recorder::open(folder / "traffic");
    ASSERT_TRUE(recorder) << recorder.error().message;
    RecordedPort recorded(std::make_unique<test::TestPort>(), std::move(*recorder));
    RunningEngine engine(folder.path(), recorded);
    engine.await(EngineState::Idle);
    Watcher watcher(*engine);
    const auto id = submit(engine);
    const auto events = watcher.until("recording", {{"state", "ended"}});
    const std::string message = Json::parse(events.back().data)["message"];
    EXPECT_NE(message.find((folder / "traffic").string()), std::string::npos) << message;
    EXPECT_EQ(recorded.onlyForJobs(), "") << "no replay would wait for it any more";
    for (int steps = 0; steps < 2; ++steps) {
        for (const EventRecord& event : watcher.until("progress", {{"job", id}}))
            EXPECT_NE(event.type, "recording") << "it is told once";
    }
    ASSERT_TRUE(engine->cancel(id));
    watcher.until("job", {{"job", id}, {"state", "cancelled"}});
    engine.end();
    const auto replay = driver::Replay::open(folder / "traffic");
    EXPECT_TRUE(replay) << "what was recorded is whole: " << replay.error().message;
}

}  // namespace
}  // namespace gonio::daemon
