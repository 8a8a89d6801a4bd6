#include "proc/optics/mirror.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace gonio::proc {
namespace {

Direction light(Radians theta) { return Direction::fromSpherical(theta, 0_deg); }

TEST(Mirror, FlatShowsTheMirrorDirection) {
    for (const Radians theta : {0_deg, 20_deg, 40_deg, 60_deg}) {
        EXPECT_LT(angleBetween({mirroredBy({}, light(theta)), mirrorOf(light(theta))}).value(),
                  1e-15);
    }
}

TEST(Mirror, AWedgeTurnsTheImageByTwiceItsAngle) {
    // Turning the normal toward +x, where the light is, moves the image toward the light.
    const Direction image = mirroredBy({0_deg, 7_deg}, light(60_deg));
    EXPECT_NEAR(image.theta().degrees(), 46, 1e-12);
    EXPECT_NEAR(image.phi().degrees(), 180, 1e-12);
    EXPECT_NEAR(mirroredBy({0_deg, -7_deg}, light(60_deg)).theta().degrees(), 74, 1e-12);
    // About x the normal leans to -y.
    const Direction side = mirroredBy({7_deg, 0_deg}, light(0_deg));
    EXPECT_NEAR(side.theta().degrees(), 14, 1e-12);
    EXPECT_NEAR(side.phi().degrees(), 270, 1e-12);
}

TEST(Mirror, NormalIsTheProductOfTheTwoTurns) {
    const Wedge wedge{3_deg, -5_deg};
    const Eigen::Vector3d normal =
        Eigen::AngleAxisd(wedge.aboutY.value(), Eigen::Vector3d::UnitY()) *
        (Eigen::AngleAxisd(wedge.aboutX.value(), Eigen::Vector3d::UnitX()) *
         Eigen::Vector3d::UnitZ());
    // The normal halves the way from the light to its image.
    const Direction wi = light(40_deg);
    const Eigen::Vector3d half = (wi.vector() + mirroredBy(wedge, wi).vector()).normalized();
    EXPECT_LT((half - normal).norm(), 1e-15);
}

TEST(Mirror, NinePlacementsAboutTwoAxes) {
    ASSERT_EQ(mirrorWedges().size(), 9U);
    EXPECT_EQ(mirrorWedges().front(), Wedge{});
    int seen = 0;
    for (const Wedge& wedge : mirrorWedges()) {
        for (const Radians theta : {0_deg, 20_deg, 40_deg, 60_deg}) {
            seen += mirroredBy(wedge, light(theta)).theta() < 75_deg ? 1 : 0;
        }
    }
    EXPECT_EQ(seen, 33);  // some of 40 and 60 degrees leave the field
}

}  // namespace
}  // namespace gonio::proc
