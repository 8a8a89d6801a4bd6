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
    ASSERT_TRUE(door.resetStream());
    EXPECT_EQ(door.clock().now(), 800us);
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

}  // namespace
}  // namespace gonio::sim
