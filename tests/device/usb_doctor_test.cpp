// gonio doctor as it is shipped, on rigs on USB: what it finds out from outside, and of a rig that
// it has claimed.

#include <umockdev.h>

#include <nlohmann/json.hpp>

#include "tests/daemon/cli/running_daemon.h"
#include "tests/device/usb_rig_fixture.h"
#include "tests/support/wait_until.h"

namespace gonio::device_test {
namespace {

using Json = nlohmann::json;

class UsbDoctor : public testing::Test {
protected:
    explicit UsbDoctor(const sim::DeviceConfig& config = rigConfig()) : rig(bus, config) {
        attribute("power/control", "on");
    }
    void attribute(const std::string& name, const std::string& value) {
        umockdev_testbed_set_attribute(
            bus.testbed(), "/sys/devices/usb1/1-1", name.c_str(), value.c_str());
    }
    /// What the doctor says, each of the rig's findings by its subject.
    Json findings(int exitCode = 0, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"--json", "doctor"});
        const test::Ran ran = gonio(more);
        EXPECT_EQ(ran.exitCode, exitCode) << ran.err << ran.out;
        Json bySubject = Json::object();
        const Json all = Json::parse(ran.out, nullptr, false);
        for (const Json& one : all.value("findings", Json::array())) {
            if (one["rig"] == "SIM-0042") bySubject[one["subject"].get<std::string>()] = one;
        }
        return bySubject;
    }

    test::Program gonio;
    MockBus bus;
    MockRig rig;
};

class UsbDoctorUsb3 : public UsbDoctor {
protected:
    UsbDoctorUsb3()
        : UsbDoctor({.serial = "SIM-0042",
                     .seed = 11,
                     .bootCount = 1,
                     .errors = {},
                     .camera = sim::CameraKind::Usb3}) {}
};

TEST_F(UsbDoctor, SoundRigHasNoAilment) {
    const Json seen = findings();
    EXPECT_EQ(seen.size(), 16U) << seen;
    for (const auto& [subject, finding] : seen.items()) {
        // A rig slowed down by a sanitizer answers late.
        if ((subject == "clock" || subject == "link") && test::kSlowdown > 1) continue;
        // Who is not root cannot look into all programs, and a busy machine reads no clock well.
        if ((subject == "holder" || subject == "clock") && finding["verdict"] == "note") continue;
        EXPECT_EQ(finding["verdict"], "ok") << finding;
    }
    EXPECT_FALSE(rig.live().with([](sim::FaultyUsb& usb) { return usb.device().lit(); }));
}

TEST_F(UsbDoctor, HandsOffItClaimsNothing) {
    const Json seen = findings(0, {"--hands-off"});
    EXPECT_EQ(seen["claim"]["verdict"], "note");
    EXPECT_FALSE(seen.contains("self-test"));
    const auto owner = rig.live().with([](sim::FaultyUsb& usb) {
        const auto report = usb.device().getFeature(0x02);
        return report ? driver::decodeSessionState(*report)->owner : driver::Owner::Lapsed;
    });
    EXPECT_EQ(owner, driver::Owner::None);
}

TEST_F(UsbDoctor, AutosuspendIsAWarning) {
    attribute("power/control", "auto");
    EXPECT_EQ(findings()["autosuspend"]["verdict"], "warn");
}

TEST_F(UsbDoctorUsb3, SuperSpeedRigAtAHighSpeedPortIsWarned) {
    EXPECT_EQ(findings()["speed"]["verdict"], "ok");
    attribute("speed", "480");
    const Json seen = findings();
    EXPECT_EQ(seen["speed"]["verdict"], "warn") << seen["speed"];
    EXPECT_EQ(seen["noise"]["verdict"], "ok") << seen["noise"];
}

TEST_F(UsbDoctor, RigThatAnotherProgramHasClaimedIsNotTaken) {
    rig.faults().claimed = true;
    const Json seen = findings(1);
    EXPECT_EQ(seen["claim"]["verdict"], "fail");
    EXPECT_NE(seen["claim"]["seen"].get<std::string>().find("another program"), std::string::npos);
}

TEST_F(UsbDoctor, RigThatDoesNotAnswerFailsInTime) {
    rig.faults().hung = true;
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_FALSE(findings(1).empty());
    EXPECT_LT(std::chrono::steady_clock::now() - begun, test::kPatience);
    rig.faults().hung = false;
}

TEST_F(UsbDoctor, RigOfTheDaemonIsExaminedByItAndFromOutside) {
    test::RunningDaemon daemon(gonio, {"--rig", "usb"});
    ASSERT_TRUE(test::waitUntil([&] {
        const Json now = Json::parse(gonio({"--json", "status"}).out, nullptr, false);
        return now["rig"]["state"] == "idle";
    }));
    const Json seen = findings();
    EXPECT_EQ(seen.size(), 16U) << seen;
    for (const auto& [subject, finding] : seen.items()) {
        if ((subject == "clock" || subject == "link") && test::kSlowdown > 1) continue;
        if (subject == "clock" && finding["verdict"] == "note") continue;  // a busy machine's
        EXPECT_EQ(finding["verdict"], "ok") << finding;
    }
    EXPECT_EQ(seen["claim"]["seen"], "goniod's, and idle");
    // Who holds the node is not looked at here: the files of a mocked node have other names.
    EXPECT_EQ(findings(0, {"--hands-off"})["self-test"]["verdict"], "note");
    EXPECT_EQ(daemon.end(), 0) << daemon.log();
    EXPECT_EQ(findings()["claim"]["seen"], "claimed, and given back dark");  // it is free again
}

}  // namespace
}  // namespace gonio::device_test
