// Two rigs on one bus, each with a daemon and a store of its own, told apart by their serial
// numbers.

#include <nlohmann/json.hpp>

#include "daemon/measurement.h"
#include "daemon/sim_bench.h"
#include "tests/daemon/cli/running_daemon.h"
#include "tests/device/usb_rig_fixture.h"
#include "tests/support/wait_until.h"

#include <httplib.h>  // after Eigen: its macros break it

namespace gonio::device_test {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

/// A rig, its daemon, and the person who puts mirrors under it.
class Bench {
public:
    Bench(MockBus& bus, std::string itsSerial, int port)
        : serial(std::move(itsSerial)),
          rig_(bus,
               {.serial = serial,
                .seed = 11,
                .bootCount = 1,
                .errors = *sim::ReferenceErrors::parse("none", 11)},
               port) {
        place({});
    }
    void serve(const std::string& which) {
        daemon_.emplace(gonio, std::vector<std::string>{"--rig", which});
    }
    [[nodiscard]] Json ask(const std::string& what) const {
        const auto answer = api().Get("/api/v1/" + what);
        EXPECT_TRUE(answer) << serial;
        return answer ? Json::parse(answer->body, nullptr, false) : Json();
    }
    void post(const std::string& what, const std::string& body) const {
        const auto answer = api().Post("/api/v1/" + what, body, "application/json");
        ASSERT_TRUE(answer) << serial;
        EXPECT_LT(answer->status, 300) << serial << ": " << answer->body;
    }
    [[nodiscard]] std::string state() const { return ask("status")["rig"]["state"]; }
    /// Gives the job that runs the mirror it waits for. False: there is none any more.
    bool serveJob() {
        const Json job = ask("status")["job"];
        if (!job.is_object()) return false;
        if (!job["wanted"].is_string() || job["question"] == answered_) return true;
        answered_ = job["question"];
        const auto wedges = proc::mirrorWedges();
        const proc::Wedge& wedge = wedges[placed_++ % wedges.size()];
        place({wedge.aboutX, wedge.aboutY});
        post("jobs/" + std::to_string(job["id"].get<int>()) + "/proceed",
             Json{{"question", answered_}}.dump());
        return true;
    }
    int endDaemon() { return daemon_->end().value_or(-1); }

    const std::string serial;
    test::Program gonio;

private:
    void place(const sim::Wedge& wedge) {
        auto store = daemon::Store::open(gonio / "store");
        ASSERT_TRUE(store) << store.error().message;
        auto placement = daemon::makePlacement(
            {.serial = serial, .seed = 11, .placed = "mirror", .wedge = wedge}, *store);
        ASSERT_TRUE(placement) << placement.error().message;
        rig_.live().with([&](sim::UsbDevice& usb) { usb.device().place(std::move(*placement)); });
    }
    [[nodiscard]] httplib::Client api() const {
        httplib::Client client((gonio / "store/goniod.sock").string(), 80);
        client.set_address_family(AF_UNIX);
        client.set_default_headers({{"Host", "localhost"}});
        return client;
    }

    MockRig rig_;
    std::optional<test::RunningDaemon> daemon_;
    Json answered_;
    std::size_t placed_ = 0;
};

class TwoRigs : public testing::Test {
protected:
    MockBus bus;
    Bench first{bus, "SIM-0042", 1}, second{bus, "SIM-0043", 2};
};

TEST_F(TwoRigs, MeasureAtTheSameTimeEachForItsOwnDaemon) {
    for (Bench* bench : {&first, &second}) bench->serve("usb:" + bench->serial);
    for (Bench* bench : {&first, &second}) {
        ASSERT_TRUE(test::waitUntil([&] { return bench->state() == "idle"; }, test::kPatience));
        EXPECT_EQ(bench->ask("status")["rig"]["serial"], bench->serial);
        std::vector<std::string> listed;
        for (const Json& rig : bench->ask("rigs")["rigs"]) listed.push_back(rig["serial"]);
        std::sort(listed.begin(), listed.end());
        EXPECT_EQ(listed, (std::vector<std::string>{"SIM-0042", "SIM-0043"}));
    }
    for (Bench* bench : {&first, &second}) bench->post("jobs", R"({"kind":"calibrate-mirror"})");
    bool together = false;
    EXPECT_TRUE(test::waitUntil(
        [&] {
            const bool one = first.serveJob(), two = second.serveJob();
            together |= one && two;
            return !one && !two;
        },
        5 * test::kPatience,
        20ms));
    EXPECT_TRUE(together);
    for (Bench* bench : {&first, &second}) {
        const Json job = bench->ask("jobs")["jobs"][0];
        EXPECT_EQ(job["state"], "done") << job;
        EXPECT_EQ(bench->ask("calibrations")["calibrations"][0]["rig"], bench->serial);
        EXPECT_EQ(bench->endDaemon(), 0);
    }
}

TEST_F(TwoRigs, WithoutASerialNumberNoneIsTakenAndBothAreNamed) {
    first.serve("usb");
    std::string obstacle;
    ASSERT_TRUE(test::waitUntil([&] {
        const Json rig = first.ask("status")["rig"];
        if (rig["obstacle"].is_string()) obstacle = rig["obstacle"];
        return !obstacle.empty();
    }));
    for (const Bench* bench : {&first, &second}) {
        EXPECT_NE(obstacle.find(bench->serial), std::string::npos) << obstacle;
    }
    EXPECT_EQ(first.ask("status")["rig"]["serial"], nullptr);
    EXPECT_EQ(first.endDaemon(), 0);
}

}  // namespace
}  // namespace gonio::device_test
