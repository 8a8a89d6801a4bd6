// Two rigs on one bus, each with a daemon and a store of its own, told apart by their serial
// numbers.

#include <nlohmann/json.hpp>

#include "tests/daemon/cli/running_daemon.h"
#include "tests/device/usb_rig_fixture.h"
#include "tests/support/wait_until.h"

#include <httplib.h>  // after Eigen: its macros break it

namespace gonio::device_test {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

/// A rig and its daemon.
class Bench {
public:
    Bench(MockBus& bus, const std::string& itsSerial, int port)
        : serial(itsSerial), rig_(bus, rigConfig(itsSerial), port) {}
    void serve(const std::string& which) {
        daemon_.emplace(gonio_, std::vector<std::string>{"--rig", which});
    }
    [[nodiscard]] Json ask(const std::string& what) const {
        const auto answer = api().Get("/api/v1/" + what);
        EXPECT_TRUE(answer) << serial;
        return answer ? Json::parse(answer->body, nullptr, false) : Json();
    }
    [[nodiscard]] std::string state() const { return ask("status")["rig"]["state"]; }
    [[nodiscard]] std::vector<std::string> rigs() const {
        std::vector<std::string> serials;
        const Json answer = ask("rigs");
        for (const Json& rig : answer.at("rigs")) serials.push_back(rig.at("serial"));
        std::sort(serials.begin(), serials.end());
        return serials;
    }
    /// Measures the dark library: many frames, and no one has to put anything under the rig.
    void begin() const {
        const auto answer =
            api().Post("/api/v1/jobs", R"({"kind":"calibrate-dark"})", "application/json");
        ASSERT_TRUE(answer) << serial;
        EXPECT_EQ(answer->status, 202) << serial << ": " << answer->body;
    }
    [[nodiscard]] bool measures() const { return ask("status")["job"].is_object(); }
    [[nodiscard]] int endDaemon() { return daemon_->end().value_or(-1); }

    const std::string serial;

private:
    [[nodiscard]] httplib::Client api() const {
        httplib::Client client((gonio_ / "store/goniod.sock").string(), 80);
        client.set_address_family(AF_UNIX);
        client.set_default_headers({{"Host", "localhost"}});
        return client;
    }

    test::Program gonio_;
    MockRig rig_;
    std::optional<test::RunningDaemon> daemon_;
};

class TwoRigs : public testing::Test {
protected:
    /// The daemon's status says in one line why, with all of `words`, and so does the doctor.
    void expectNoneTaken(const std::string& which, const std::vector<std::string>& words) {
        first.serve(which);
        std::string obstacle;
        ASSERT_TRUE(test::waitUntil([&] {
            const Json status = first.ask("status");
            if (status["rig"]["obstacle"].is_string()) obstacle = status["rig"]["obstacle"];
            return !obstacle.empty();
        }));
        const std::string claim = first.ask("doctor")["findings"][0]["seen"];
        for (const std::string& word : words) {
            EXPECT_NE(obstacle.find(word), std::string::npos) << obstacle;
            EXPECT_NE(claim.find(word), std::string::npos) << claim;
        }
        EXPECT_EQ(obstacle.find('\n'), std::string::npos) << obstacle;
        EXPECT_EQ(first.ask("status")["rig"]["serial"], nullptr);
        EXPECT_EQ(first.endDaemon(), 0);
    }
    MockBus bus;
    Bench first{bus, "SIM-0042", 1}, second{bus, "SIM-0043", 2};
};

TEST_F(TwoRigs, MeasureAtTheSameTimeEachForItsOwnDaemon) {
    const std::vector<Bench*> benches{&first, &second};
    for (Bench* bench : benches) bench->serve("usb:" + bench->serial);
    for (const Bench* bench : benches) {
        ASSERT_TRUE(test::waitUntil([&] { return bench->state() == "idle"; }));
        EXPECT_EQ(bench->ask("status")["rig"]["serial"], bench->serial);
        EXPECT_EQ(bench->rigs(), (std::vector<std::string>{"SIM-0042", "SIM-0043"}));
    }
    for (const Bench* bench : benches) bench->begin();
    bool together = false;
    EXPECT_TRUE(test::waitUntil(
        [&] {
            const bool one = first.measures(), two = second.measures();
            together |= one && two;
            return !one && !two;
        },
        5 * test::kPatience,
        20ms));
    EXPECT_TRUE(together);
    for (Bench* bench : benches) {
        const Json jobs = bench->ask("jobs");
        EXPECT_EQ(jobs["jobs"][0]["state"], "done") << jobs;
        EXPECT_EQ(bench->ask("calibrations")["calibrations"][0]["rig"], bench->serial);
        EXPECT_EQ(bench->endDaemon(), 0);
    }
}

TEST_F(TwoRigs, WithoutASerialNumberNoneIsTakenAndBothAreNamed) {
    expectNoneTaken("usb", {"SIM-0042", "SIM-0043", "usb:"});
}

TEST_F(TwoRigs, OfAWrongSerialNumberNoneIsTakenAndAllAreNamed) {
    expectNoneTaken("usb:SIM-0044", {"SIM-0042", "SIM-0043", "SIM-0044"});
}

}  // namespace
}  // namespace gonio::device_test
