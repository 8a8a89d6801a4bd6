#include "proc/models/oren_nayar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

Direction at(double theta, double phi = 0) {
    return Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
}

double green(double sigma, const LightView& pair) {
    const OrenNayar<double> model{Bands<double>::all(1), sigma};
    return model.f<Effort::Reference>(pairOf<double>(pair)).g;
}

TEST(OrenNayarModel, IsLambertAtSigmaZero) {
    for (double theta : {0.0, 30.0, 89.0}) {
        for (double phi : {0.0, 90.0, 180.0})
            EXPECT_DOUBLE_EQ(green(0, {at(60), at(theta, phi)}), 1 / kPi);
    }
}

TEST(OrenNayarModel, IsEquationThirtyInAngles) {
    for (double sigma : {0.1, 0.3, 1.0}) {
        const double s2 = sigma * sigma;
        const double a = 1 - 0.5 * s2 / (s2 + 0.33);
        const double b = 0.45 * s2 / (s2 + 0.09);
        for (double thetaIn : {10.0, 45.0, 80.0}) {
            for (double thetaOut : {5.0, 45.0, 70.0}) {
                for (double phi : {0.0, 60.0, 120.0, 180.0}) {
                    const Radians alpha = Radians::fromDegrees(std::max(thetaIn, thetaOut));
                    const Radians beta = Radians::fromDegrees(std::min(thetaIn, thetaOut));
                    const double wanted = (a + b * std::max(0.0, cos(Radians::fromDegrees(phi))) *
                                                   sin(alpha) * tan(beta)) /
                                          kPi;
                    // cos(90 deg) and the like are off by an ulp of 1; tan(80 deg) = 5.7 of them.
                    EXPECT_NEAR(green(sigma, {at(thetaIn), at(thetaOut, phi)}), wanted, 1e-14);
                }
            }
        }
    }
}

TEST(OrenNayarModel, ScattersBackMoreThanForward) {
    for (double theta : {20.0, 60.0, 85.0})
        EXPECT_GT(green(0.4, {at(60), at(theta, 0)}), green(0.4, {at(60), at(theta, 180)}));
}

TEST(OrenNayarModel, HasNoAzimuthAtThePole) {
    for (double phi : {0.0, 77.0, 180.0})
        EXPECT_DOUBLE_EQ(green(0.3, {at(0), at(50, phi)}), green(0.3, {at(0), at(50, 0)}));
}

TEST(OrenNayarModel, ReachesAnAlbedoOfOnePointOhOneFiveNearGrazing) {
    // Midpoint rule over theta and phi. In the limit beta = theta_o, and the integral is A + B / 2;
    // the rule is off by the square of its steps, some 1e-5.
    constexpr int kRings = 400, kSectors = 180;
    double albedo = 0;
    for (int i = 0; i < kRings; ++i) {
        const Radians theta((i + 0.5) * kPi / 2 / kRings);
        const double weight = cos(theta) * sin(theta) * kPi * kPi / (kRings * kSectors);
        for (int j = 0; j < kSectors; ++j) {
            const Radians phi((j + 0.5) * 2 * kPi / kSectors);
            albedo += green(0.2, {at(89.999), Direction::fromSpherical(theta, phi)}) * weight;
        }
    }
    const double a = 1 - 0.5 * 0.04 / 0.37;
    const double b = 0.45 * 0.04 / 0.13;
    EXPECT_NEAR(albedo, a + b / 2, 1e-4);
    EXPECT_NEAR(albedo, 1.015, 5e-4);  // to its last digit
}

}  // namespace
}  // namespace gonio::proc
