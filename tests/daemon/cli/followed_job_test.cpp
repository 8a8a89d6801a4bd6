// The program with a daemon that breaks off, asks, refuses, or speaks another version's language.

#include <pty.h>
#include <signal.h>

#include "tests/daemon/cli/scripted_daemon.h"

namespace gonio {
namespace {

using test::exitCodeOf;
using test::Ran;
using Json = nlohmann::json;

constexpr int kInternal = 1, kUsage = 2, kNoRig = 3, kInterrupted = 8;

const std::string kAsks =
    "event: operator\ndata: {\"job\":7,\"question\":1,\"wanted\":\"turn the tile\"}";
const std::string kDone = "event: job\ndata: {\"job\":7,\"state\":\"done\"}";
const std::string kDocument =
    R"({"problem":null,"message":null,"result":{"rig":"S","states":12,"rig_seconds":1.5}})";

class WithScriptedDaemon : public testing::Test {
protected:
    Ran calibrate(std::vector<std::string> more = {}) {
        std::vector<std::string> all{"calibrate", "black"};
        all.insert(all.end(), more.begin(), more.end());
        return gonio(all);
    }
    static std::string progress(int step) {
        return "event: progress\ndata: {\"job\":7,\"step\":" + std::to_string(step) +
               ",\"steps\":3,\"what\":\"dark\",\"elapsed_s\":1,\"left_s\":2}";
    }
    test::Program gonio;
    test::ScriptedDaemon daemon{gonio};
};

TEST_F(WithScriptedDaemon, StreamThatBreaksOffIsTakenUpAgainWhereItWas) {
    daemon.play({.events = {progress(1), progress(2), kDone},
                 .status = R"({"daemon":{"newest_event":0},"job":{"id":7,"question":null}})",
                 .job = kDocument});
    const Ran ran = calibrate();
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    EXPECT_NE(ran.out.find("12 states"), std::string::npos) << ran.out;
}

TEST_F(WithScriptedDaemon, WhatTheJobWaitsForIsSaidAndThatItGoesOn) {
    const auto rig = [](const std::string& state, const std::string& detail) {
        return R"(event: rig
data: {"state":")" +
               state + R"(","serial":"S","detail":")" + detail + "\"}";
    };
    daemon.play({.events = {rig("running", ""),
                            rig("suspended", "INTERLOCK: seat it again"),
                            rig("running", ""),
                            kDone},
                 .status = R"({"daemon":{"newest_event":0},"job":{"id":7,"question":null}})",
                 .job = kDocument});
    const Ran ran = calibrate();
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    EXPECT_NE(ran.err.find("waiting for the rig: INTERLOCK: seat it again\nthe job goes on\n"),
              std::string::npos)
        << ran.err;
}

TEST_F(WithScriptedDaemon, SetbackIsSaidWithItsBracket) {
    const std::string setback =
        "event: setback\ndata: {\"job\":7,\"bracket\":\"LED 1 g\",\"cause\":\"repeated\","
        "\"message\":\"frame 4 is bit for bit the picture before\"}";
    const std::string status = R"({"daemon":{"newest_event":0},"job":{"id":7,"question":null}})";
    daemon.play({.events = {progress(1), setback, kDone}, .status = status, .job = kDocument});
    const Ran ran = calibrate();
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    EXPECT_NE(ran.err.find("setback in LED 1 g: frame 4 is bit for bit the picture before\n"),
              std::string::npos)
        << ran.err;
}

TEST_F(WithScriptedDaemon, SampleWithoutLightIsNotSaidToBeExact) {
    const std::string document =
        R"({"problem":null,"message":null,"result":{"name":"x","measured_cells":5,)"
        R"("median_relative_uncertainty":null,"rig_seconds":2,"planned":{"seconds":1.9},)"
        R"("compute_seconds":7,"qc":[],"file":"x.gonio"}})";
    daemon.play({.events = {kDone},
                 .status = R"({"daemon":{"newest_event":0},"job":{"id":7,"question":null}})",
                 .job = document});
    const Ran ran = gonio({"measure", "x"});
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    EXPECT_NE(ran.out.find("x: 5 BRDF samples, none of them above 0, "), std::string::npos)
        << ran.out;
}

TEST_F(WithScriptedDaemon, JobIsFollowedWithoutAStreamToo) {
    daemon.play({.refusesStreams = true, .job = kDocument});
    const Ran ran = calibrate();
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
}

TEST_F(WithScriptedDaemon, ErrorOfTheJobIsFoundInTheLogbookWhereNoEventTold) {
    daemon.play({.refusesStreams = true,
                 .job = R"({"problem":"quality","message":"too dark","result":null})"});
    const Ran ran = calibrate();
    EXPECT_EQ(ran.exitCode, 7);
    EXPECT_NE(ran.err.find("too dark"), std::string::npos) << ran.err;
}

TEST_F(WithScriptedDaemon, ResultThatWasNotKeptIsSaid) {
    daemon.play({.events = {kDone}});
    const Ran ran = calibrate();
    EXPECT_EQ(ran.exitCode, kInternal);
    EXPECT_NE(ran.err.find("not in the logbook"), std::string::npos) << ran.err;
}

TEST_F(WithScriptedDaemon, QuestionIsAnsweredByItsNumberAndOnce) {
    daemon.play(
        {.events = {kAsks, kDone},
         .status =
             R"({"daemon":{"newest_event":0},"job":{"id":7,"question":1,"wanted":"turn the tile"}})",
         .job = kDocument});
    const Ran ran = calibrate({"--yes"});
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    EXPECT_EQ(daemon.posted("/api/v1/jobs/7/proceed"),
              std::vector<std::string>{R"({"question":1})"});
}

TEST_F(WithScriptedDaemon, AnswerThatComesTooLateIsSaidAndTheJobFollowedOn) {
    daemon.play({.events = {kAsks, kDone}, .job = kDocument, .proceedStatus = 409});
    const Ran ran = calibrate({"--yes"});
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    EXPECT_NE(ran.err.find("nobody asks this"), std::string::npos) << ran.err;
}

TEST_F(WithScriptedDaemon, WithoutATerminalNobodyCanAnswer) {
    daemon.play({.events = {kAsks}});
    const Ran ran = calibrate();
    EXPECT_EQ(ran.exitCode, kUsage);
    EXPECT_NE(ran.err.find("turn the tile: this needs a person at a terminal, or --yes; the job is "
                           "cancelled"),
              std::string::npos)
        << ran.err;
    EXPECT_EQ(daemon.posted("/api/v1/jobs/7/cancel").size(), 1U);
}

/// A terminal that the test types at.
class Terminal {
public:
    Terminal() { EXPECT_EQ(openpty(&person_, &program_, name_, nullptr, nullptr), 0); }
    ~Terminal() {
        ::close(person_);
        ::close(program_);
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;
    [[nodiscard]] std::string path() const { return name_; }
    void type(const std::string& keys) const {
        EXPECT_EQ(::write(person_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
    }

private:
    int person_ = -1, program_ = -1;
    char name_[256]{};
};

TEST_F(WithScriptedDaemon, CtrlDAtAQuestionIsNoAnswerAndCancels) {
    daemon.play({.events = {kAsks}});
    const Terminal terminal;
    const pid_t child = test::spawnProcess(
        {GONIO_PROGRAM, "--store", (gonio / "store").string(), "calibrate", "black"},
        gonio / "out",
        gonio / "err",
        terminal.path());
    ASSERT_TRUE(test::waitUntil(
        [&] { return test::textOf(gonio / "err").find("press Enter") != std::string::npos; }));
    terminal.type("\x04");
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(exitCodeOf(status), kInterrupted);
    EXPECT_NE(test::textOf(gonio / "err").find("no answer; the job is cancelled"),
              std::string::npos)
        << test::textOf(gonio / "err");
    EXPECT_EQ(daemon.posted("/api/v1/jobs/7/cancel").size(), 1U);
    EXPECT_TRUE(daemon.posted("/api/v1/jobs/7/proceed").empty());
}

TEST_F(WithScriptedDaemon, DaemonThatEndsLeavesWordOfTheJob) {
    daemon.play({.status = R"({"daemon":{"newest_event":0},"job":{"id":7,"question":null}})"});
    const pid_t child = test::spawnProcess(
        {GONIO_PROGRAM, "--store", (gonio / "store").string(), "calibrate", "black"},
        gonio / "out",
        gonio / "err");
    ASSERT_TRUE(test::waitUntil([&] { return !daemon.posted("/api/v1/jobs").empty(); }));
    daemon.stop();
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(exitCodeOf(status), kNoRig);
    EXPECT_NE(test::textOf(gonio / "err").find("job 7: gonio jobs"), std::string::npos)
        << test::textOf(gonio / "err");
}

TEST_F(WithScriptedDaemon, WatchingEndsWithTheDaemonAndSaysSo) {
    const Ran ran = gonio({"watch"});
    EXPECT_EQ(ran.exitCode, kNoRig);
    EXPECT_NE(ran.err.find("the daemon has ended"), std::string::npos) << ran.err;
}

TEST_F(WithScriptedDaemon, AnotherVersionsAnswersAreNotUnderstoodAndNoCrash) {
    for (const char* said : {"no JSON", "[]", "{}", R"({"rig":1,"job":[],"daemon":{}})"}) {
        daemon.play({.status = said});
        for (const auto& command : {std::vector<std::string>{"status"},
                                    {"calibrate", "black"},
                                    {"jobs", "cancel"},
                                    {"jobs", "proceed"},
                                    {"watch"}}) {
            const Ran ran = gonio(command);
            EXPECT_TRUE(ran.exitCode == kInternal || ran.exitCode == kUsage)
                << said << " " << command.front() << " " << ran.exitCode << " " << ran.err;
            EXPECT_EQ(ran.err.find("internal error"), std::string::npos) << ran.err;
        }
    }
}

TEST_F(WithScriptedDaemon, EventOfAnotherVersionEndsTheFollowingWithAWord) {
    daemon.play({.events = {"event: progress\ndata: {\"job\":7,\"step\":\"one\"}"}});
    const Ran ran = calibrate();
    EXPECT_EQ(ran.exitCode, kInternal);
    EXPECT_NE(ran.err.find("not understood"), std::string::npos) << ran.err;
}

TEST_F(WithScriptedDaemon, DoctorsCureForADaemonThatDoesNotSayIsForItsReason) {
    const auto claimed = [&](int status, const std::string& answer) {
        daemon.play({.status = R"({"daemon":{"pid":5},"rig":{"kind":"sim","serial":"S",)"
                               R"("obstacle":null}})",
                     .doctor = answer,
                     .doctorStatus = status});
        const Ran ran = gonio({"--json", "doctor"});
        const Json all = Json::parse(ran.out, nullptr, false);
        for (const Json& one : all.value("findings", Json::array())) {
            if (one["rig"] == "S" && one["subject"] == "claim") return one;
        }
        ADD_FAILURE() << ran.err << ran.out;
        return Json{{"seen", ""}, {"cure", ""}};
    };
    const auto problem = [](const std::string& type) {
        return R"({"type":"urn:gonio:problem:)" + type + R"(","detail":"because"})";
    };
    const auto isOfVersion = [](const Json& claim) {
        return claim["cure"].get<std::string>().find("version") != std::string::npos;
    };
    EXPECT_TRUE(isOfVersion(claimed(404, problem("usage"))));
    EXPECT_TRUE(isOfVersion(claimed(200, R"({"other":[]})")));
    const Json busy = claimed(409, problem("busy"));
    EXPECT_FALSE(isOfVersion(busy)) << busy;
    EXPECT_NE(busy["cure"], "");
    EXPECT_NE(busy["seen"].get<std::string>().find("because"), std::string::npos) << busy;
}

}  // namespace
}  // namespace gonio
