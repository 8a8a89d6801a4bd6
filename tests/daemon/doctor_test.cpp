// The doctor, on computers that a test makes up.

#include "daemon/doctor.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

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
    [[nodiscard]] Finding finding(const std::string& subject) const {
        for (const Finding& one : examine(patient)) {
            if (one.subject == subject) return one;
        }
        ADD_FAILURE() << subject;
        return {};
    }

    test::TempFolder root;
    Patient patient{.root = root.path(),
                    .store = root / "store",
                    .rigs = std::vector<driver::UsbRig>(),
                    .daemon = {}};
    const driver::UsbRig rig{.serial = "R-1", .place = "1-2", .protocol = "GRP/1.0"};
};

TEST_F(Doctor, ComputerWithoutARigIsOnlyNoted) {
    put("run/udev/control");
    put("usr/lib/udev/rules.d/70-gonio.rules");
    put("sys/module/usbcore/parameters/usbfs_memory_mb", "16\n");
    fs::create_directories(root / "sys/class/hidraw");
    const auto findings = examine(patient);
    ASSERT_EQ(findings.size(), 8U);
    for (const Finding& one : findings) {
        EXPECT_LE(one.verdict, Verdict::Note) << one.subject << ": " << one.seen;
    }
}

TEST_F(Doctor, RigThatMayNotBeOpenedIsBadAndItsCureIsSaid) {
    patient.rigs = std::vector{rig};
    EXPECT_EQ(finding("usb").verdict, Verdict::Good);
    EXPECT_NE(finding("usb").seen.find("R-1"), std::string::npos);
    EXPECT_EQ(finding("permission").verdict, Verdict::Good);
    patient.rigs->front().obstacle = "no permission: put the line";
    EXPECT_EQ(finding("permission").verdict, Verdict::Bad);
    EXPECT_NE(finding("permission").seen.find("put the line"), std::string::npos);
}

TEST_F(Doctor, RigWithoutAHidrawNodeIsBad) {
    patient.rigs = std::vector{rig};
    fs::create_directories(root / "sys/class/hidraw");
    EXPECT_EQ(finding("hidraw").verdict, Verdict::Bad);
    fs::create_directories(root / "sys/class/hidraw/hidraw0");
    EXPECT_EQ(finding("hidraw").verdict, Verdict::Good);
}

TEST_F(Doctor, LittleUsbMemoryIsAWarningThatNamesTheFile) {
    put("sys/module/usbcore/parameters/usbfs_memory_mb", "15\n");
    EXPECT_EQ(finding("usbfs-memory").verdict, Verdict::Warning);
    EXPECT_NE(finding("usbfs-memory").cure.find("usbfs_memory_mb"), std::string::npos);
    put("sys/module/usbcore/parameters/usbfs_memory_mb", "16\n");
    EXPECT_EQ(finding("usbfs-memory").verdict, Verdict::Good);
    put("sys/module/usbcore/parameters/usbfs_memory_mb", "0\n");  // no limit
    EXPECT_EQ(finding("usbfs-memory").verdict, Verdict::Good);
}

TEST_F(Doctor, StoreInAFileOfAnothersIsBad) {
    patient.store = "/proc/1/store";
    EXPECT_EQ(finding("store").verdict, Verdict::Bad);
    patient.store = root / "not/made/yet";
    EXPECT_LE(finding("store").verdict, Verdict::Warning);  // by what this disk has free
}

TEST_F(Doctor, MissingDaemonOrUsbIsAWarning) {
    EXPECT_EQ(finding("daemon").verdict, Verdict::Good);
    patient.daemon = Error{ErrorKind::NoRig, "no daemon at /x"};
    EXPECT_EQ(finding("daemon").verdict, Verdict::Warning);
    EXPECT_NE(finding("daemon").cure.find("goniod"), std::string::npos);
    patient.rigs = Error{ErrorKind::NoRig, "libusb: no USB"};
    EXPECT_EQ(finding("usb").verdict, Verdict::Warning);
}

}  // namespace
}  // namespace gonio::daemon
