#include "driver/capture_ids.h"

#include <gtest/gtest.h>

#include <set>

namespace gonio::driver {
namespace {

TEST(CaptureIds, HoldPlanStepAndAttempt) {
    CaptureIds ids;
    EXPECT_EQ(ids.next(5), 0x50001U);
    EXPECT_EQ(ids.next(6), 0x60001U);
    EXPECT_EQ(ids.next(0), 1U) << "never 0";
}

TEST(CaptureIds, AttemptsGoOnWhenAnotherStepCameBetween) {
    CaptureIds ids;
    std::set<std::uint64_t> used;
    for (int i = 0; i < 20; ++i) {
        EXPECT_TRUE(used.insert(ids.next(5)).second);
        EXPECT_TRUE(used.insert(ids.next(6)).second);
    }
    EXPECT_EQ(*used.rbegin(), 0x60014U);
}

TEST(CaptureIds, WrapWithoutZero) {
    CaptureIds ids;
    for (int i = 1; i <= 0xFFFF; ++i) EXPECT_EQ(ids.next(0), static_cast<std::uint64_t>(i));
    EXPECT_EQ(ids.next(0), 1U);
}

}  // namespace
}  // namespace gonio::driver
