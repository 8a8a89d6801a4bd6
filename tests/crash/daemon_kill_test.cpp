// A daemon that is ended or killed in the middle of a measurement, and the one that comes after it.
// A first test; named failpoints prove it later.

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/daemon/cli/lab_bench.h"

namespace gonio {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

class DaemonKill : public testing::Test {
protected:
    Json ask(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "--json");
        const test::Ran ran = gonio(arguments);
        EXPECT_EQ(ran.exitCode, 0) << ran.err;
        return Json::parse(ran.out, nullptr, false);
    }
    /// A rig with all its references, by a daemon that is gone again.
    void calibrate() const {
        test::RunningDaemon daemon(gonio, rig);
        for (const std::string reference : {"mirror", "black", "white"}) {
            ask({"sim", "place", reference});
            ask({"calibrate", reference});
        }
        ask({"sim", "place", "model:lambert,albedo=0.5"});
        ask({"measure", "kept", "--effort", "draft"});
        EXPECT_EQ(daemon.end(), 0) << daemon.log();
    }
    /// Begins a measurement and returns once it has taken `steps`.
    pid_t measureUntil(const std::string& name, int steps) const {
        const pid_t client = test::spawnProcess(
            {GONIO_PROGRAM, "--store", (gonio / "store").string(), "measure", name},
            gonio / "client.out",
            gonio / "client.err");
        const auto begin = std::chrono::steady_clock::now();
        while (std::chrono::steady_clock::now() - begin < 30s) {
            const Json job = ask({"status"})["job"];
            if (job.is_object() && job["step"] >= steps) return client;
            std::this_thread::sleep_for(10ms);
        }
        ADD_FAILURE() << "the measurement did not come that far";
        return client;
    }
    [[nodiscard]] static int wait(pid_t client) {
        int status = 0;
        waitpid(client, &status, 0);
        return test::exitCodeOf(status);
    }
    [[nodiscard]] std::string csv(const std::string& sample) const {
        const std::string file = gonio / "sample.csv";
        EXPECT_EQ(gonio({"convert", "sample:" + sample, file, "-q"}).exitCode, 0);
        return test::textOf(file);
    }

    test::Program gonio;
    const std::vector<std::string> rig = test::simExposing("[20, 320]", gonio);
};

/// How a daemon ends in the middle of a measurement, and what its client says then.
struct Ending {
    int signal;
    int steps;
    int daemonExit;
    int clientExit;
};

TEST_F(DaemonKill, NothingAcknowledgedIsLostAndTheNextDaemonGoesOn) {
    calibrate();
    const std::string kept = csv("kept");
    constexpr int kGone = 3, kInterrupted = 8;
    std::vector<Ending> endings{{SIGKILL, 1, 128 + SIGKILL, kGone},
                                {SIGKILL, 17, 128 + SIGKILL, kGone},
                                {SIGTERM, 5, 0, kInterrupted}};
    if (std::getenv("GONIO_NIGHTLY") != nullptr) {
        endings.push_back({SIGKILL, 9, 128 + SIGKILL, kGone});
    }
    for (const Ending& ending : endings) {
        {
            test::RunningDaemon daemon(gonio, rig);
            const pid_t client = measureUntil("torn", ending.steps);
            const auto begin = std::chrono::steady_clock::now();
            EXPECT_EQ(daemon.end(ending.signal), ending.daemonExit) << daemon.log();
            EXPECT_LT(std::chrono::steady_clock::now() - begin, 3s);
            EXPECT_EQ(wait(client), ending.clientExit) << test::textOf(gonio / "client.err");
        }
        EXPECT_NE(ending.signal == SIGTERM, std::filesystem::exists(gonio / "store/goniod.sock"));
        const auto begin = std::chrono::steady_clock::now();
        test::RunningDaemon next(gonio, rig);
        EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s);
        const Json job = ask({"jobs"})["jobs"][0];
        EXPECT_EQ(job["state"], "interrupted") << job;
        EXPECT_EQ(job["problem"], "interrupted");
        EXPECT_EQ(csv("kept"), kept);
        EXPECT_EQ(gonio({"info", "sample:torn"}).exitCode, 6) << "half a sample";
        EXPECT_EQ(ask({"status"})["rig"]["state"], "idle");
    }
    test::RunningDaemon last(gonio, rig);
    ask({"measure", "torn", "--effort", "draft"});
    EXPECT_EQ(ask({"samples"})["samples"].size(), 2U);
}

}  // namespace
}  // namespace gonio
