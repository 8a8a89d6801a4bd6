#include "proc/table/axis.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace gonio::proc {
namespace {

const std::vector<double> kAxis{0, 20, 40, 60};

TEST(Axis, FindsNodesThroughRounding) {
    for (double away : {-1e-10, 0.0, 1e-10}) {
        const auto place = placeOn(kAxis, 40 + away);
        ASSERT_TRUE(place && place->atNode());
        EXPECT_EQ(place->low, 2U);
    }
}

TEST(Axis, DividesBetweenNodes) {
    const auto place = placeOn(kAxis, 25);
    ASSERT_TRUE(place);
    EXPECT_EQ(place->low, 1U);
    EXPECT_EQ(place->high, 2U);
    EXPECT_DOUBLE_EQ(place->t, 0.25);
}

TEST(Axis, IsEmptyOutsideAndWithoutNodes) {
    EXPECT_FALSE(placeOn(kAxis, -0.001));
    EXPECT_FALSE(placeOn(kAxis, 60.001));
    EXPECT_FALSE(placeOn(kAxis, std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(placeOn({}, 0));
    EXPECT_TRUE(placeOn(std::vector<double>{7}, 7));
    EXPECT_FALSE(placeOn(std::vector<double>{7}, 7.1));
}

TEST(Axis, ClosesTheCircleOnlyBetweenNeighbours) {
    const std::vector<double> open{0, 90, 180, 270};
    const auto place = placeOnCircle(open, -22.5);
    ASSERT_TRUE(place);
    EXPECT_EQ(place->low, 3U);
    EXPECT_EQ(place->high, 0U);
    EXPECT_DOUBLE_EQ(place->t, 0.75);
    EXPECT_FALSE(placeOnCircle(std::vector<double>{0, 90, 180}, 200));
}

TEST(Axis, TakesWholeTurnsOff) {
    const std::vector<double> closed{0, 120, 240, 360};
    for (double turns : {-720.0, -360.0, 0.0, 360.0, 3600.0}) {
        const auto place = placeOnCircle(closed, 240 + turns);
        ASSERT_TRUE(place && place->atNode());
        EXPECT_EQ(place->low, 2U);
    }
    EXPECT_FALSE(placeOnCircle(closed, std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace gonio::proc
