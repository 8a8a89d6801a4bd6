#include "driver/protocol/constants.h"

#include <gtest/gtest.h>

#include <set>

namespace gonio::driver {
namespace {

// Numbers and names as the protocol's page has them.
const std::vector<std::pair<std::uint16_t, std::string>> kStatuses{
    {0, "OK"},          {1, "PENDING"},       {101, "BAD_ARG"},   {102, "BAD_STATE"},
    {103, "BAD_CRC"},   {104, "UNSUPPORTED"}, {105, "NOT_OWNER"}, {106, "BUSY"},
    {107, "BAD_SEQ"},   {201, "INTERLOCK"},   {202, "OVER_TEMP"}, {203, "LED_OPEN"},
    {204, "LED_DRIFT"}, {205, "SENSOR"},      {206, "HEARTBEAT"}, {207, "LINK"},
    {301, "OVERRUN"},   {302, "FRAME_GONE"},  {303, "BAD_RANGE"}, {900, "INTERNAL"}};
const std::vector<std::string> kOps{"PING",
                                    "SET_LED",
                                    "SET_EXPOSURE",
                                    "SET_FORMAT",
                                    "ARM",
                                    "TRIGGER",
                                    "ABORT",
                                    "RESEND",
                                    "FLUSH",
                                    "SYNC_TIME",
                                    "CLEAR_FAULT",
                                    "REBOOT"};

TEST(StatusName, KnowsEveryStatusAndSaysTheNumberOfOthers) {
    std::size_t named = 0;
    for (std::uint16_t code = 0; code < 1000; ++code) {
        const std::string name = statusName(code);
        if (name == "status " + std::to_string(code)) continue;
        ASSERT_LT(named, kStatuses.size());
        EXPECT_EQ(code, kStatuses[named].first);
        EXPECT_EQ(name, kStatuses[named].second);
        ++named;
    }
    EXPECT_EQ(named, kStatuses.size());
    EXPECT_EQ(statusName(65535), "status 65535");
}

TEST(OpName, KnowsEveryOperationAndSaysTheNumberOfOthers) {
    for (std::size_t i = 0; i < kOps.size(); ++i)
        EXPECT_EQ(opName(static_cast<Op>(i + 1)), kOps[i]);
    EXPECT_EQ(opName(static_cast<Op>(0)), "op 0");
    EXPECT_EQ(opName(static_cast<Op>(kOps.size() + 1)), "op 13");
    EXPECT_EQ(opName(static_cast<Op>(255)), "op 255");
}

TEST(Interlock, LightNeedsTheSampleSeatedAndTheCoverClosed) {
    EXPECT_EQ(interlock::kMayLight & interlock::kModule, 0);
    EXPECT_EQ(interlock::kMayLight, 3);
    EXPECT_TRUE(interlock::mayLight(interlock::kMayLight | interlock::kModule));
    EXPECT_FALSE(interlock::mayLight(interlock::kSeated));
    EXPECT_FALSE(interlock::mayLight(interlock::kCoverClosed));
    EXPECT_EQ(validity::kAll, 7);
}

}  // namespace
}  // namespace gonio::driver
