// The doctor, on computers that a test makes up.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "daemon/device_holders.h"
#include "daemon/doctor_system.h"
#include "daemon/doctor_usb.h"
#include "driver/udev_rule.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

class Doctor : public testing::Test {
protected:
    void put(const std::string& path, const std::string& text = "") const {
        const fs::path file = root / path;
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    void link(const std::string& path, const std::string& target) const {
        const fs::path file = root / path;
        fs::create_directories(file.parent_path());
        fs::create_symlink(target, file);
    }
    [[nodiscard]] static Finding only(const std::vector<Finding>& findings,
                                      const std::string& subject) {
        for (const Finding& one : findings) {
            if (one.subject == subject) return one;
        }
        ADD_FAILURE() << subject;
        return {};
    }
    [[nodiscard]] Finding finding(const std::string& subject) const {
        return only(examineComputer(patient), subject);
    }

    test::TempFolder root;
    Patient patient{.root = root.path(),
                    .store = root / "store",
                    .rigs = std::vector<driver::UsbRig>(),
                    .daemon = DaemonSeen{.pid = 77}};
};

TEST_F(Doctor, ComputerWithoutARigIsOnlyNoted) {
    put("run/udev/control");
    put("usr/lib/udev/rules.d/70-gonio.rules");
    put("sys/module/usbcore/parameters/usbfs_memory_mb", "16\n");
    fs::create_directories(root / "sys/class/hidraw");
    const auto findings = examineComputer(patient);
    ASSERT_EQ(findings.size(), 7U);
    for (const Finding& one : findings) {
        EXPECT_LE(one.verdict, Verdict::Note) << one.subject << ": " << one.seen;
    }
}

TEST_F(Doctor, VerdictsHaveTheWordsOfTheSchema) {
    EXPECT_EQ(name(Verdict::Ok), "ok");
    EXPECT_EQ(name(Verdict::Note), "note");
    EXPECT_EQ(name(Verdict::Warn), "warn");
    EXPECT_EQ(name(Verdict::Fail), "fail");
    for (const Verdict one : {Verdict::Ok, Verdict::Note, Verdict::Warn, Verdict::Fail})
        EXPECT_EQ(parseVerdict(name(one)), one);
    EXPECT_FALSE(parseVerdict("good"));
}

TEST_F(Doctor, LittleUsbMemoryIsAWarningThatNamesTheFile) {
    put("sys/module/usbcore/parameters/usbfs_memory_mb", "15\n");
    EXPECT_EQ(finding("usbfs-memory").verdict, Verdict::Warn);
    EXPECT_NE(finding("usbfs-memory").cure.find("usbfs_memory_mb"), std::string::npos);
    put("sys/module/usbcore/parameters/usbfs_memory_mb", "16\n");
    EXPECT_EQ(finding("usbfs-memory").verdict, Verdict::Ok);
    put("sys/module/usbcore/parameters/usbfs_memory_mb", "0\n");  // no limit
    EXPECT_EQ(finding("usbfs-memory").verdict, Verdict::Ok);
}

TEST_F(Doctor, StoreInAFileOfAnothersIsAFailure) {
    patient.store = "/proc/1/store";
    EXPECT_EQ(finding("store").verdict, Verdict::Fail);
    patient.store = root / "not/made/yet";
    EXPECT_LE(finding("store").verdict, Verdict::Warn);  // by what this disk has free
}

TEST_F(Doctor, MissingDaemonOrUsbIsAWarning) {
    EXPECT_EQ(finding("daemon").verdict, Verdict::Ok);
    patient.daemon = Error{ErrorKind::NoRig, "no daemon at /x"};
    EXPECT_EQ(finding("daemon").verdict, Verdict::Warn);
    EXPECT_NE(finding("daemon").cure.find("goniod"), std::string::npos);
    patient.rigs = Error{ErrorKind::NoRig, "libusb: no USB"};
    EXPECT_EQ(finding("usb").verdict, Verdict::Warn);
}

TEST_F(Doctor, DaemonThatIsHinderedIsAWarningThatSaysWhy) {
    patient.daemon->obstacle = "two rigs: SIM-0042, SIM-0043";
    EXPECT_EQ(finding("daemon").verdict, Verdict::Warn);
    EXPECT_NE(finding("daemon").seen.find("SIM-0042, SIM-0043"), std::string::npos);
    EXPECT_NE(finding("daemon").cure.find("see usb"), std::string::npos);
    patient.daemon->rigSerial = "SIM-0042";
    EXPECT_EQ(finding("daemon").cure, "see claim of rig SIM-0042");
}

TEST_F(Doctor, KernelWithoutHidrawIsAWarning) {
    EXPECT_EQ(finding("hidraw").verdict, Verdict::Warn);
    fs::create_directories(root / "sys/class/hidraw/hidraw0");
    EXPECT_EQ(finding("hidraw").verdict, Verdict::Ok);
    EXPECT_EQ(finding("hidraw").seen, "1 node");
}

TEST(UdevRule, IsTheOneThatIsInstalled) {
    std::ifstream in(GONIO_SOURCE_DIR "/config/linux/70-gonio.rules");
    const std::string installed(std::istreambuf_iterator<char>(in), {});
    for (const std::string& line : driver::udevRule(0x1209, 0x0001)) {
        EXPECT_NE(installed.find("\n" + line + "\n"), std::string::npos) << line;
    }
}

TEST(DeviceHolders, AreFoundInTheRealProc) {
    const test::TempFolder folder;
    const std::string node = folder / "node";
    std::ofstream(node).put('\n');
    const pid_t holder = ::fork();
    if (holder == 0) {
        ::dup2(::open(node.c_str(), O_RDONLY), STDIN_FILENO);
        ::execl("/bin/sleep", "sleep", "60", nullptr);
        ::_exit(1);
    }
    DeviceHolders found;
    EXPECT_TRUE(test::waitUntil([&] {  // until the child has opened it and become sleep
        found = holdersOf({node}, "/", ::getpid());
        return !found.holders.empty() && found.holders.front().program == "sleep";
    }));
    EXPECT_EQ(found.holders, (std::vector<DeviceHolder>{{holder, "sleep", node}}));
    EXPECT_TRUE(holdersOf({node}, "/", holder).holders.empty());  // it is oneself
    ::kill(holder, SIGKILL);
    ::waitpid(holder, nullptr, 0);
}

/// A sound rig in /sys, that nobody uses.
class DoctorOfARig : public Doctor {
protected:
    static constexpr const char* kDevice = "sys/bus/usb/devices/1-2/";
    static constexpr const char* kHidraw = "1-2:1.0/0003:1209:0001.0004/hidraw/hidraw3/dev";

    DoctorOfARig() {
        sys("busnum", "1\n");
        sys("devnum", "7\n");
        sys("power/control", "on\n");
        sys("power/autosuspend_delay_ms", "2000\n");
        sys("1-2:1.0/bInterfaceClass", "03\n");
        sys("1-2:1.1/bInterfaceClass", "ff\n");
        sys(kHidraw, "");
        link(kDevice + std::string("1-2:1.0/driver"), "../../drivers/usbhid");
        put("proc/200/comm", "bash\n");
        link("proc/200/fd/0", "/dev/null");
    }
    void sys(const std::string& file, const std::string& text) const { put(kDevice + file, text); }
    void open(int pid, const std::string& program, const std::string& node) const {
        const std::string process = "proc/" + std::to_string(pid);
        put(process + "/comm", program + "\n");
        link(process + "/fd/5", node);
    }
    [[nodiscard]] Finding seen(const std::string& subject) const {
        return only(examineOutside(patient, rig), subject);
    }

    driver::UsbRig rig{.vendor = 0x1209,
                       .product = 0x0001,
                       .serial = "R-1",
                       .place = "1-2",
                       .protocol = "GRP/1.0",
                       .obstacle = "",
                       .speed = 480};
};

TEST_F(DoctorOfARig, SoundRigHasNoAilment) {
    const auto findings = examineOutside(patient, rig);
    ASSERT_EQ(findings.size(), 7U);
    for (const Finding& one : findings) {
        EXPECT_EQ(one.verdict, Verdict::Ok) << one.subject << ": " << one.seen;
        EXPECT_EQ(one.cure, "") << one.subject;
    }
    EXPECT_EQ(inTheWay(patient, rig), "");
    EXPECT_EQ(seen("hidraw-node").seen, "/dev/hidraw3");
    EXPECT_EQ(seen("kernel-driver").seen, "reports: usbhid, stream: none");
}

TEST_F(DoctorOfARig, WithoutPermissionTheRuleIsPrintedInFull) {
    rig.obstacle = "no permission for /dev/hidraw3: " + driver::permissionCure(0x1209, 0x0001);
    const Finding permission = seen("permission");
    EXPECT_EQ(permission.verdict, Verdict::Fail);
    EXPECT_EQ(permission.seen, "no permission for /dev/hidraw3");
    for (const std::string& line : driver::udevRule(0x1209, 0x0001)) {
        EXPECT_NE(permission.cure.find("\n" + line + "\n"), std::string::npos) << permission.cure;
    }
    EXPECT_NE(inTheWay(patient, rig), "");
}

TEST_F(DoctorOfARig, AnotherObstacleIsSaidAsItIs) {
    rig.obstacle = "its HID interface has no hidraw node";
    EXPECT_EQ(seen("permission").verdict, Verdict::Fail);
    EXPECT_EQ(seen("permission").seen, rig.obstacle);
    EXPECT_NE(seen("permission").cure.find("hidraw-node"), std::string::npos);
}

TEST_F(DoctorOfARig, AnotherMajorProtocolIsAFailureThatNamesBoth) {
    rig.protocol = "GRP/1.9";
    EXPECT_EQ(seen("protocol").verdict, Verdict::Ok);
    rig.protocol = "GRP/2.0";
    EXPECT_EQ(seen("protocol").verdict, Verdict::Fail);
    EXPECT_EQ(seen("protocol").seen, "the rig speaks GRP/2.0, this program GRP/1.0");
    rig.protocol = "";
    EXPECT_EQ(seen("protocol").verdict, Verdict::Note);
}

TEST_F(DoctorOfARig, KernelDriverOnTheStreamIsAWarningThatNamesIt) {
    link(kDevice + std::string("1-2:1.1/driver"), "../../drivers/usbtest");
    EXPECT_EQ(seen("kernel-driver").verdict, Verdict::Warn);
    EXPECT_EQ(seen("kernel-driver").seen, "reports: usbhid, stream: usbtest");
    EXPECT_NE(seen("kernel-driver").cure.find("blacklist usbtest"), std::string::npos);
}

TEST_F(DoctorOfARig, WithoutAHidrawNodeNothingWorks) {
    fs::remove_all(root / (kDevice + std::string("1-2:1.0/0003:1209:0001.0004")));
    EXPECT_EQ(seen("hidraw-node").verdict, Verdict::Fail);
    EXPECT_NE(seen("hidraw-node").cure.find("modprobe usbhid"), std::string::npos);
}

TEST_F(DoctorOfARig, FullSpeedFailsAndASuperSpeedRigAtHighSpeedIsWarned) {
    rig.speed = 12;
    EXPECT_EQ(seen("speed").verdict, Verdict::Fail);
    rig.speed = 480;
    rig.superSpeed = true;
    EXPECT_EQ(seen("speed").verdict, Verdict::Warn);
    EXPECT_NE(seen("speed").cure.find("SuperSpeed cable"), std::string::npos);
    rig.speed = 5000;
    EXPECT_EQ(seen("speed").verdict, Verdict::Ok);
    rig.speed = 0;
    EXPECT_EQ(seen("speed").verdict, Verdict::Note);
}

TEST_F(DoctorOfARig, AutosuspendIsAWarningUnlessItNeverComes) {
    sys("power/control", "auto\n");
    EXPECT_EQ(seen("autosuspend").verdict, Verdict::Warn);
    EXPECT_NE(seen("autosuspend").seen.find("2000 ms"), std::string::npos);
    EXPECT_NE(seen("autosuspend").cure.find("echo on > "), std::string::npos);
    sys("power/autosuspend_delay_ms", "-1000\n");
    EXPECT_EQ(seen("autosuspend").verdict, Verdict::Ok);
}

TEST_F(DoctorOfARig, WhoHasItIsNamedWithHisPid) {
    open(321, "other-program", "/dev/bus/usb/001/007");
    EXPECT_EQ(seen("holder").verdict, Verdict::Fail);
    EXPECT_EQ(seen("holder").seen, "open in other-program (pid 321)");
    EXPECT_NE(inTheWay(patient, rig).find("other-program (pid 321)"), std::string::npos);
}

TEST_F(DoctorOfARig, WhoReadsItsReportsOnlyIsNamedAndNotInTheWay) {
    open(322, "gamepads", "/dev/hidraw3");
    EXPECT_EQ(seen("holder").verdict, Verdict::Warn);
    EXPECT_NE(seen("holder").seen.find("gamepads (pid 322)"), std::string::npos);
    EXPECT_EQ(inTheWay(patient, rig), "");
    open(323, "others", "/dev/hidraw4");  // of another device
    EXPECT_EQ(seen("holder").seen.find("others"), std::string::npos);
}

TEST_F(DoctorOfARig, DaemonsRigThatIsNotShownIsUnpluggedOnlyWhereNeitherHasIt) {
    const auto verdict = [&](Verdict claim) {
        const Finding one = unshown(patient, {{"claim", claim, "goniod's", ""}});
        EXPECT_EQ(one.subject, "usb");
        EXPECT_NE(one.cure, "");
        return one.verdict;
    };
    patient.rigs = std::vector{rig};  // another one
    EXPECT_EQ(verdict(Verdict::Fail), Verdict::Fail);
    EXPECT_EQ(verdict(Verdict::Ok), Verdict::Note);
    EXPECT_EQ(verdict(Verdict::Note), Verdict::Note) << "goniod did not say";
    rig.serial.clear();
    patient.rigs = std::vector{rig};
    EXPECT_EQ(verdict(Verdict::Fail), Verdict::Note) << "it may be this one";
    patient.rigs = Error{ErrorKind::NoRig, "libusb: no USB"};
    EXPECT_EQ(verdict(Verdict::Fail), Verdict::Note) << "in a container";
    EXPECT_EQ(verdict(Verdict::Ok), Verdict::Note);
}

TEST_F(DoctorOfARig, TheDaemonThatWasAskedMayHaveIt) {
    patient.daemon = DaemonSeen{.pid = 55, .rigKind = "usb", .rigSerial = "R-1"};
    open(55, "goniod", "/dev/bus/usb/001/007");
    EXPECT_EQ(seen("holder").verdict, Verdict::Ok);
    EXPECT_NE(inTheWay(patient, rig).find("goniod (pid 55)"), std::string::npos);
    patient.daemon = DaemonSeen{.pid = 56};  // it has none
    EXPECT_EQ(seen("holder").verdict, Verdict::Fail);
}

TEST_F(DoctorOfARig, OfTwoRigsTheOtherDaemonsIsOnlyNotedAndLeftAlone) {
    patient.daemon = DaemonSeen{.pid = 55, .rigKind = "usb", .rigSerial = "R-2"};
    open(66, "goniod", "/dev/bus/usb/001/007");
    EXPECT_EQ(seen("holder").verdict, Verdict::Note);
    EXPECT_NE(inTheWay(patient, rig).find("goniod (pid 66)"), std::string::npos);
}

TEST_F(DoctorOfARig, ClaimByAProgramThatCannotBeSeenIsAFailure) {
    link(kDevice + std::string("1-2:1.1/driver"), "../../drivers/usbfs");
    EXPECT_EQ(seen("holder").verdict, Verdict::Fail);
    EXPECT_NE(seen("holder").cure.find("as root"), std::string::npos);
}

}  // namespace
}  // namespace gonio::daemon
