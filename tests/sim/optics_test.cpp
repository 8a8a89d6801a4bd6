#include "sim/optics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

namespace gonio::sim {
namespace {

constexpr ImagePoint kMiddle{640, 512};
const std::vector<std::string> kSerials{"SIM-0001", "SIM-0002", "A", "Z-99", "lab"};

TEST(Optics, PixelAndDirectionAreInverse) {
    for (const std::string& serial : kSerials) {
        const Optics optics(serial, kMiddle);
        for (double theta = 0; theta <= 75.9; theta += 5.06) {
            for (double phi = 0; phi < 360; phi += 37) {
                const Direction wo = Direction::fromSpherical(Radians::fromDegrees(theta),
                                                              Radians::fromDegrees(phi));
                const auto back = optics.directionAt(optics.pixelOf(wo));
                ASSERT_TRUE(back);
                EXPECT_LE(angleBetween({wo, *back}).value(), 1e-12);
            }
        }
    }
}

TEST(Optics, FieldStopFitsTheWindow) {
    for (const std::string& serial : kSerials) {
        const Optics optics(serial, kMiddle);
        for (double phi = 0; phi < 360; phi += 1) {
            const ImagePoint at =
                optics.pixelOf(Direction::fromSpherical(76_deg, Radians::fromDegrees(phi)));
            EXPECT_GE(at.x, 128);
            EXPECT_LE(at.x, 1152);
            EXPECT_GE(at.y, 0);
            EXPECT_LE(at.y, 1024);
        }
        EXPECT_FALSE(optics.directionAt({0, 0}));
    }
}

TEST(Optics, DiffersFromRigToRigWithinItsTolerances) {
    const ImagePoint a = Optics("SIM-0001", kMiddle).pixelOf(Direction());
    const ImagePoint b = Optics("SIM-0002", kMiddle).pixelOf(Direction());
    EXPECT_GT(std::hypot(a.x - b.x, a.y - b.y), 0.1);
    EXPECT_LE(std::hypot(a.x - kMiddle.x, a.y - kMiddle.y), 8);
}

TEST(Optics, HasAboutFortyFourPixelsPerSquareDegreeInTheMiddle) {
    const Optics optics("SIM-0001", kMiddle);
    const ImagePoint a = optics.pixelOf(Direction());
    const ImagePoint b = optics.pixelOf(Direction::fromSpherical(1_deg, 0_deg));
    const double perDegree = std::hypot(a.x - b.x, a.y - b.y);
    EXPECT_NEAR(perDegree * perDegree, 44, 1.5);
}

TEST(Optics, SolidAngleIsTheJacobianOfTheMapping) {
    const Optics optics("SIM-0003", kMiddle);
    const auto areaOf = [&](Radians theta) {
        // Solid angle of a small square of the image, from its corners.
        const ImagePoint at = optics.pixelOf(Direction::fromSpherical(theta, 30_deg));
        const double h = 0.05;
        const auto a = *optics.directionAt({at.x - h, at.y - h});
        const auto b = *optics.directionAt({at.x + h, at.y - h});
        const auto c = *optics.directionAt({at.x - h, at.y + h});
        return (b.vector() - a.vector()).cross(c.vector() - a.vector()).norm();
    };
    const double middle = areaOf(Radians(1e-3));
    for (double theta : {10.0, 40.0, 70.0}) {
        const Direction wo = Direction::fromSpherical(Radians::fromDegrees(theta), 30_deg);
        EXPECT_NEAR(areaOf(wo.theta()) / middle, optics.relativeSolidAngle(wo), 2e-3);
    }
}

TEST(Optics, VignettingFallsTowardTheRim) {
    const Optics optics("SIM-0001", kMiddle);
    EXPECT_EQ(optics.vignetting(Direction()), 1);
    EXPECT_LT(optics.vignetting(Direction::fromSpherical(75_deg, 0_deg)), 0.95);
}

}  // namespace
}  // namespace gonio::sim
