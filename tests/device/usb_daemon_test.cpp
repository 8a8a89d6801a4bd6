// goniod and gonio as they are shipped, on a rig on USB: the real libraries in the daemon's
// process, the simulated rig behind the mocked bus in this one.

#include <array>
#include <fstream>
#include <future>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/logbook.h"
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

constexpr const char* kSerial = "SIM-0042";
constexpr std::uint64_t kSeed = 11;
constexpr const char* kSample = "model:lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.3,f0=0.04";
/// A rig, and the person who puts things under it.
class Lab : public testing::Test {
protected:
    explicit Lab(sim::CameraKind camera = sim::CameraKind::Usb2) : camera_(camera) {}
    void SetUp() override { place("mirror"); }
    void place(const std::string& what, const sim::Wedge& wedge = {}) {
        auto store = daemon::Store::open(gonio / "store");
        ASSERT_TRUE(store) << store.error().message;
        auto placement = daemon::makePlacement(
            {.serial = kSerial, .seed = kSeed, .placed = what, .wedge = wedge}, *store);
        ASSERT_TRUE(placement) << placement.error().message;
        rig.live().with([&](sim::FaultyUsb& usb) { usb.device().place(std::move(*placement)); });
    }
    Json ask(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "--json");
        const test::Ran ran = gonio(arguments);
        EXPECT_EQ(ran.exitCode, 0) << ran.err;
        return Json::parse(ran.out, nullptr, false);
    }
    /// Asked for by this process itself: a client started for each look would take the processor
    /// from the rig.
    [[nodiscard]] Json status() const {
        const auto answer = api().Get("/api/v1/status");
        EXPECT_TRUE(answer);
        return answer ? Json::parse(answer->body, nullptr, false) : Json();
    }
    /// Waits until the daemon's status is as wanted.
    template <class Wanted>
    void await(const std::string& what, Wanted wanted) const {
        EXPECT_TRUE(test::waitUntil([&] { return wanted(status()); }, test::kPatience, 20ms))
            << "not seen: " << what;
    }
    void awaitState(const std::string& state) const {
        await(state, [&](const Json& now) { return now["rig"]["state"] == state; });
    }
    [[nodiscard]] pid_t begin(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {GONIO_PROGRAM, "--store", (gonio / "store").string()});
        return test::spawnProcess(arguments, gonio / "client.out", gonio / "client.err");
    }
    [[nodiscard]] int end(pid_t client) const {
        int code = 0;
        waitpid(client, &code, 0);
        return test::exitCodeOf(code);
    }
    [[nodiscard]] bool lit() {
        return rig.live().with([](sim::FaultyUsb& usb) { return usb.device().lit(); });
    }
    [[nodiscard]] httplib::Client api() const {
        httplib::Client client((gonio / "store/goniod.sock").string(), 80);
        client.set_address_family(AF_UNIX);
        client.set_default_headers({{"Host", "localhost"}});
        return client;
    }
    void cause(sim::DueFault fault) {
        rig.live().with([&](sim::FaultyUsb& usb) { usb.cause(std::move(fault)); });
    }
    /// In the middle of its lit frames.
    [[nodiscard]] pid_t beginSensor() {
        const pid_t client = begin({"--json", "calibrate", "sensor"});
        await("a lit LED", [&](const Json& now) {
            return lit() && now["job"].is_object() && now["job"]["step"] >= 20;
        });
        return client;
    }
    /// A measurement in whose middle the rig is unplugged, and comes back in this way.
    void measureInterrupted(const std::string& name, sim::FaultKind comesBack) {
        const pid_t client = begin({"--json", "measure", name, "--effort", "draft"});
        await("the states' frames",
              [](const Json& now) { return now["job"].is_object() && now["job"]["step"] >= 21; });
        rig.unplug();
        awaitState("interrupted");
        cause({.kind = comesBack});
        EXPECT_EQ(end(client), 0) << test::textOf(gonio / "client.err");
        const Json measured = Json::parse(test::textOf(gonio / "client.out"));
        const Json& gaps = measured["interruptions"];
        ASSERT_EQ(gaps.size(), 1U) << gaps;
        EXPECT_EQ(gaps[0]["same_boot"], comesBack == sim::FaultKind::Plug);
        EXPECT_EQ(ask({"info", measured["file"]})["interruptions"], 1);
    }
    /// Data of the kept events of this type.
    [[nodiscard]] std::string eventsOf(const std::string& type) const {
        auto book = daemon::Logbook::open(gonio / "store");
        EXPECT_TRUE(book) << book.error().message;
        std::string all;
        const auto events = book->eventsAfter(0, 1000);
        EXPECT_TRUE(events) << events.error().message;
        for (const daemon::EventRecord& event : *events) {
            if (event.type == type) all += event.data + "\n";
        }
        return all;
    }
    /// Begins a job that no client follows.
    void post(const std::string& kind) const {
        const auto answer =
            api().Post("/api/v1/jobs", R"({"kind":")" + kind + R"("})", "application/json");
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->status, 202) << answer->body;
    }

    /// The lens map, the mirror put on each wedge as the daemon asks for it.
    void calibrateMirror() {
        post("calibrate-mirror");
        for (const proc::Wedge& wedge : proc::mirrorWedges()) {
            await("a wish for a mirror", [](const Json& now) {
                return now["job"].is_object() && now["job"]["wanted"].is_string();
            });
            place("mirror", {wedge.aboutX, wedge.aboutY});
            ask({"jobs", "proceed"});
        }
        awaitState("idle");
        EXPECT_EQ(ask({"jobs"})["jobs"][0]["state"], "done");
    }

private:
    sim::CameraKind camera_;

protected:
    test::Program gonio;
    MockBus bus;
    MockRig rig{bus,
                {.serial = kSerial,
                 .seed = kSeed,
                 .bootCount = 1,
                 .errors = *sim::ReferenceErrors::parse("none", kSeed),
                 .camera = camera_}};
};

class LabUsb3 : public Lab {
protected:
    LabUsb3() : Lab(sim::CameraKind::Usb3) {}
};

constexpr double kMostStreamingMebibytes = 150;

/// A process's resident set, MiB: now ("VmRSS:"), or the largest so far ("VmHWM:").
double mebibytes(pid_t pid, const std::string& which) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/status");
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with(which)) return std::stod(line.substr(which.size())) / 1024;
    }
    return 0;
}

/// Processor seconds of a process so far.
double processorSeconds(pid_t pid) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
    std::string word;
    for (int i = 0; i < 13; ++i) in >> word;
    double user = 0, system = 0;
    in >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Each cell's value and uncertainty, as text.
std::string csvOf(const test::Program& gonio, const std::string& sample) {
    const std::string file = gonio / (sample + ".csv");
    EXPECT_EQ(gonio({"convert", "sample:" + sample, file, "-q"}).exitCode, 0);
    return test::rowsOfCsv(file);
}

/// The same on the simulated rig in the daemon's own process, three times.
std::array<std::string, 3> inProcess() {
    const test::Program gonio;
    const test::RunningDaemon daemon(gonio);
    const auto run = [&](const std::vector<std::string>& arguments) {
        const test::Ran ran = gonio(arguments);
        EXPECT_EQ(ran.exitCode, 0) << ran.err;
    };
    run({"sim",
         "place",
         "mirror",
         "--serial",
         kSerial,
         "--seed",
         std::to_string(kSeed),
         "--systematic",
         "none",
         "-q"});
    run({"calibrate", "mirror", "-q"});
    for (const std::string tile : {"black", "white"}) {
        run({"sim", "place", tile, "-q"});
        run({"calibrate", tile, "-q"});
    }
    run({"sim", "place", kSample, "-q"});
    std::array<std::string, 3> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string name(1, "xyz"[i]);
        run({"measure", name, "--effort", "draft", "-q"});
        all[i] = csvOf(gonio, name);
    }
    return all;
}

TEST_F(Lab, MeasuresOnUsbWhatItMeasuresInProcess) {
    if (test::kThreadSanitizer) {
        GTEST_SKIP() << "this long, a rig slowed down so much misses a deadline of the driver; "
                        "the tests below have the same threads";
    }
    test::RunningDaemon daemon(gonio, {"--rig", "usb"});
    awaitState("idle");
    auto twin = std::async(std::launch::async, inProcess);
    EXPECT_EQ(ask({"rigs"})["rigs"][0]["serial"], kSerial);
    const double idle = mebibytes(daemon.pid(), "VmHWM:");

    calibrateMirror();
    const double streaming = mebibytes(daemon.pid(), "VmHWM:");
    EXPECT_LE(streaming, kMostStreamingMebibytes * test::kSlowdown);
    for (const std::string tile : {"black", "white"}) {
        place(tile);
        ask({"calibrate", tile});
    }
    place(kSample);
    const double before = processorSeconds(daemon.pid());
    const pid_t client = begin({"--json", "measure", "x", "--effort", "draft"});
    double measuring = 0;
    await("the end of the frames", [&](const Json& now) {
        if (now["rig"]["state"] == "running") {
            measuring = std::max(measuring, mebibytes(daemon.pid(), "VmRSS:"));
        }
        return now["rig"]["state"] == "finishing";
    });
    const double frames = processorSeconds(daemon.pid()) - before;
    EXPECT_EQ(end(client), 0) << test::textOf(gonio / "client.err");
    const Json measured = Json::parse(test::textOf(gonio / "client.out"));
    std::cout << "goniod: " << idle << " MiB idle, " << streaming << " MiB calibrating the mirror, "
              << measuring << " MiB measuring, " << mebibytes(daemon.pid(), "VmHWM:")
              << " MiB at most; a draft measurement " << measured["rig_seconds"]
              << " s on the rig, " << measured["compute_seconds"] << " s computing, " << frames
              << " s of processor time until the last frame\n";

    measureInterrupted("y", sim::FaultKind::Plug);
    measureInterrupted("z", sim::FaultKind::PlugRebooted);
    const auto wanted = twin.get();
    EXPECT_TRUE(csvOf(gonio, "x") == wanted[0]);  // megabytes: no one reads their difference
    EXPECT_TRUE(csvOf(gonio, "y") == wanted[1]) << "all that an unplug costs is time";
    EXPECT_TRUE(csvOf(gonio, "z") == wanted[2]) << "no bracket mixes boots, and each is whole";
    EXPECT_EQ(daemon.end(), 0) << daemon.log();
    EXPECT_FALSE(lit());
}

TEST_F(LabUsb3, CalibratesTheMirrorAtSixtyFrames) {
    test::RunningDaemon daemon(
        gonio, {"--rig", "usb", "--profile", GONIO_SOURCE_DIR "/config/rigs/minidiff-usb3.toml"});
    awaitState("idle");
    calibrateMirror();
    const double streaming = mebibytes(daemon.pid(), "VmHWM:");
    std::cout << "goniod: " << streaming << " MiB calibrating the mirror over USB 3, "
              << processorSeconds(daemon.pid()) << " s of processor time\n";
    EXPECT_LE(streaming, kMostStreamingMebibytes * test::kSlowdown);
}

TEST_F(Lab, UnpluggedInTheMiddleTheJobIsInterruptedAndTheRigIsFoundAgain) {
    test::RunningDaemon daemon(gonio, {"--rig", "usb", "--comeback-seconds", "0"});
    awaitState("idle");
    const pid_t client = begin({"--yes", "calibrate", "mirror"});
    await("the third step",
          [](const Json& now) { return now["job"].is_object() && now["job"]["step"] >= 3; });
    rig.unplug();
    EXPECT_EQ(end(client), 5) << test::textOf(gonio / "client.err");
    const Json job = ask({"jobs"})["jobs"][0];
    EXPECT_EQ(job["state"], "interrupted") << job;
    const Json after = status();
    EXPECT_EQ(after["rig"]["state"], "offline") << after;
    EXPECT_EQ(gonio({"calibrate", "mirror"}).exitCode, 3);
    rig.plug();
    awaitState("idle");
    EXPECT_FALSE(lit());
}

TEST_F(Lab, RigThatHasLostItsPowerIsTakenUpAndTheBracketIsTakenAgain) {
    place("white");
    test::RunningDaemon daemon(gonio, {"--rig", "usb"});
    awaitState("idle");
    const pid_t client = beginSensor();
    rig.unplug();
    awaitState("interrupted");
    cause({.kind = sim::FaultKind::PlugRebooted});
    EXPECT_EQ(end(client), 0) << test::textOf(gonio / "client.err");
    const Json gaps = Json::parse(test::textOf(gonio / "client.out"))["interruptions"];
    ASSERT_EQ(gaps.size(), 1U) << gaps;
    EXPECT_EQ(gaps[0]["same_boot"], false);
    EXPECT_NE(eventsOf("setback").find("new-boot"), std::string::npos) << eventsOf("setback");
    EXPECT_NE(eventsOf("interruption"), "");
}

TEST_F(Lab, AnotherRigInItsPlaceIsRefusedByNameAndTheJobWaitsOn) {
    place("white");
    test::RunningDaemon daemon(gonio, {"--rig", "usb"});
    awaitState("idle");
    const pid_t client = beginSensor();
    rig.unplug();
    awaitState("interrupted");
    cause({.kind = sim::FaultKind::PlugAs, .name = "SIM-0099"});
    await("both serials", [](const Json& now) {
        const std::string obstacle =
            now["rig"]["obstacle"].is_string() ? now["rig"]["obstacle"] : "";
        return obstacle.find(kSerial) != std::string::npos &&
               obstacle.find("SIM-0099") != std::string::npos;
    });
    EXPECT_EQ(status()["rig"]["state"], "interrupted");
    cause({.kind = sim::FaultKind::Unplug});
    rig.plug();
    EXPECT_EQ(end(client), 0) << test::textOf(gonio / "client.err");
    EXPECT_EQ(Json::parse(test::textOf(gonio / "client.out"))["interruptions"].size(), 1U);
}

TEST_F(Lab, KilledInTheMiddleTheRigGoesDarkAndTheNextDaemonTakesItUp) {
    std::optional<test::RunningDaemon> daemon;
    daemon.emplace(gonio, std::vector<std::string>{"--rig", "usb"});
    awaitState("idle");
    const pid_t client = begin({"--yes", "calibrate", "mirror"});
    await("a lit LED", [&](const Json&) { return lit(); });
    daemon->end(SIGKILL);
    EXPECT_EQ(end(client), 3);
    daemon.emplace(gonio, std::vector<std::string>{"--rig", "usb"});
    awaitState("idle");  // by the same claim, before the rig has missed the first one's heartbeat
    const auto begun = std::chrono::steady_clock::now();
    while (lit() && std::chrono::steady_clock::now() - begun < 2500ms) {
        std::this_thread::sleep_for(10ms);
    }
    EXPECT_FALSE(lit());
    EXPECT_EQ(ask({"jobs"})["jobs"][0]["state"], "interrupted");
}

TEST_F(Lab, OpenInterlockSuspendsTheJobUntilItIsClosedAgain) {
    place("white");
    test::RunningDaemon daemon(gonio, {"--rig", "usb"});
    awaitState("idle");
    const pid_t client = beginSensor();
    cause({.kind = sim::FaultKind::OpenInterlock});
    awaitState("suspended");
    EXPECT_NE(status()["rig"]["obstacle"].dump().find("seat it again"), std::string::npos);
    EXPECT_FALSE(lit());
    cause({.kind = sim::FaultKind::CloseInterlock});
    EXPECT_EQ(end(client), 0) << test::textOf(gonio / "client.err");
    EXPECT_NE(test::textOf(gonio / "client.err").find("seat it again"), std::string::npos);
    EXPECT_NE(eventsOf("setback").find("suspended"), std::string::npos);
}

TEST_F(Lab, OpenInterlockFailsTheJobThatDoesNotWaitAndIsOverWhenItCloses) {
    test::RunningDaemon daemon(gonio, {"--rig", "usb", "--comeback-seconds", "0"});
    awaitState("idle");
    const pid_t client = begin({"--yes", "calibrate", "mirror"});
    await("a lit LED", [&](const Json&) { return lit(); });
    rig.live().with([](sim::FaultyUsb& usb) { usb.device().setInterlock(0); });
    EXPECT_EQ(end(client), 5) << test::textOf(gonio / "client.err");
    awaitState("fault");
    EXPECT_EQ(gonio({"calibrate", "mirror"}).exitCode, 5);
    rig.live().with(
        [](sim::FaultyUsb& usb) { usb.device().setInterlock(driver::interlock::kMayLight); });
    awaitState("idle");
}

}  // namespace
}  // namespace gonio::device_test
