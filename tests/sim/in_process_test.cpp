#include "sim/in_process.h"

#include <gtest/gtest.h>

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;
using driver::ReportId;

constexpr auto kIdent = static_cast<std::uint8_t>(ReportId::Ident);

TEST(InProcessDoor, SaysWhoIsBehindIt) {
    const InProcessDoor door({.serial = "SIM-0042", .errors = {}});
    EXPECT_EQ(door.strings().serial, "SIM-0042");
    EXPECT_EQ(door.strings().protocol, "GRP/1.0");
    EXPECT_EQ(door.clock().now(), 0ns);
}

TEST(InProcessDoor, AControlTransferCostsAFifthOfAMillisecond) {
    InProcessDoor door({});
    ASSERT_TRUE(door.getFeature(kIdent));
    EXPECT_EQ(door.clock().now(), 200us);
    ASSERT_TRUE(door.setFeature(driver::encodeEventsFrom(1)));
    EXPECT_EQ(door.clock().now(), 400us);
    ASSERT_TRUE(door.write(driver::encode(driver::Command{})));
    EXPECT_EQ(door.clock().now(), 600us);
}

TEST(InProcessDoor, AnUnknownReportStalls) {
    InProcessDoor door({});
    const auto unknown = door.getFeature(0x7F);
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().kind, ErrorKind::Device);
    EXPECT_NE(unknown.error().message.find("127"), std::string::npos);
    driver::Report report{};
    report[0] = kIdent;  // can be read, not set
    EXPECT_FALSE(door.setFeature(report));
}

TEST(InProcessDoor, WaitingForNothingEndsAtTheDeadlineExactly) {
    InProcessDoor door({});
    const Nanoseconds start = door.clock().now();
    const auto none = door.readBulk(123'456'789ns);
    ASSERT_TRUE(none);
    EXPECT_FALSE(*none);
    EXPECT_EQ(door.clock().now() - start, 123'456'789ns);
    const auto now = door.readBulk(0ns);
    ASSERT_TRUE(now);
    EXPECT_FALSE(*now);
    EXPECT_EQ(door.clock().now() - start, 123'456'789ns);
}

TEST(InProcessDoor, StatusComesTenTimesASecond) {
    InProcessDoor door({});
    int statuses = 0;
    while (door.clock().now() < 2s) {
        const auto report = door.readInput(2s - door.clock().now());
        ASSERT_TRUE(report);
        if (*report && (**report)[0] == static_cast<std::uint8_t>(ReportId::Status)) {
            EXPECT_TRUE(driver::decodeStatus(**report));
            ++statuses;
        }
    }
    EXPECT_NEAR(statuses, 20, 1);
}

/// Nanoseconds that a byte of a waiting chunk takes.
double nanosecondsPerByte(CameraKind camera) {
    InProcessDoor door({.errors = {}, .camera = camera});
    EXPECT_TRUE(door.setFeature(driver::encode(driver::SessionSet{.sessionId = 7})));
    EXPECT_TRUE(door.write(
        driver::encode(driver::Command{.sessionLow = 7,
                                       .sequence = 1,
                                       .op = driver::Op::Arm,
                                       .arguments = driver::encode(driver::Arm{.captureId = 1})})));
    door.device().advanceTo(100ms);
    EXPECT_TRUE(door.readBulk(0ns).value());  // the leader
    const Nanoseconds begin = door.clock().now();
    const auto data = door.readBulk(0ns).value();
    if (!data) return 0;
    return static_cast<double>((door.clock().now() - begin).count()) /
           static_cast<double>(data->size());
}

TEST(InProcessDoor, BulkCostsWhatTheCamerasUsbCarries) {
    EXPECT_NEAR(nanosecondsPerByte(CameraKind::Usb2), 25, 1e-3);   // 40 MB/s
    EXPECT_NEAR(nanosecondsPerByte(CameraKind::Usb3), 2.5, 1e-3);  // 400 MB/s
}

}  // namespace
}  // namespace gonio::sim
