#include "sim/source_disc.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "proc/models/spec.h"

namespace gonio::sim {
namespace {

/// The mean of f over a disc by 40 x 240 points of equal weight.
double fineMean(const Scatterer& surface, const Direction& middle, Radians diameter) {
    constexpr int kRings = 40;
    constexpr int kSpokes = 240;
    const Eigen::Vector3d across = middle.vector().unitOrthogonal();
    const Eigen::Vector3d along = middle.vector().cross(across);
    const Direction out = Direction::fromSpherical(41_deg, 180_deg);
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
        const double angle = diameter.value() / 2 * std::sqrt((i + 0.5) / kRings);
        for (int j = 0; j < kSpokes; ++j) {
            const double around = 2 * kPi * (j + 0.5) / kSpokes;
            const Eigen::Vector3d toward = std::cos(around) * across + std::sin(around) * along;
            const auto in =
                Direction::fromVector(std::cos(angle) * middle.vector() + std::sin(angle) * toward);
            sum += surface.answer({.in = *in, .out = out}).f[Band::G];
        }
    }
    return sum / (kRings * kSpokes);
}

double discMean(const Scatterer& surface, const Direction& middle, Radians diameter) {
    const Direction out = Direction::fromSpherical(41_deg, 180_deg);
    double sum = 0;
    for (const SourcePoint& point : sourceDisc(middle, diameter)) {
        sum += point.weight * surface.answer({.in = point.direction, .out = out}).f[Band::G];
    }
    return sum;
}

TEST(SourceDisc, WeightsSumToOneAndTheFirstIsTheMiddle) {
    const Direction middle = Direction::fromSpherical(60_deg, 0_deg);
    const auto points = sourceDisc(middle, 1_deg);
    double weights = 0;
    for (const SourcePoint& point : points) weights += point.weight;
    EXPECT_EQ(weights, 1);
    EXPECT_EQ(points[0].direction.vector(), middle.vector());
    for (std::size_t i = 1; i < points.size(); ++i) {
        EXPECT_NEAR(
            angleBetween({middle, points[i].direction}).degrees(), 0.5 * std::sqrt(2.0 / 3), 1e-12);
    }
}

TEST(SourceDisc, IsExactForPolynomialsUpToTheFifthDegree) {
    // On a small disc angles are plane coordinates u, v: the means of u^a v^b over a disc of
    // radius R are R^2 / 4 for u^2, R^4 / 8 for u^4, R^4 / 24 for u^2 v^2, and 0 for odd ones.
    constexpr double kR = 1e-4;
    const auto mean = [](int a, int b) {
        double sum = 0;
        for (const SourcePoint& p : sourceDisc(Direction(), Radians(2 * kR))) {
            sum += p.weight * std::pow(p.direction.x() / kR, a) * std::pow(p.direction.y() / kR, b);
        }
        return sum;
    };
    constexpr double kCurvature = 1e-8;  // sines for angles: R^2
    EXPECT_NEAR(mean(2, 0), 1.0 / 4, kCurvature);
    EXPECT_NEAR(mean(0, 2), 1.0 / 4, kCurvature);
    EXPECT_NEAR(mean(4, 0), 1.0 / 8, kCurvature);
    EXPECT_NEAR(mean(0, 4), 1.0 / 8, kCurvature);
    EXPECT_NEAR(mean(2, 2), 1.0 / 24, kCurvature);
    for (const auto& [a, b] : {std::pair{1, 0},
                               {0, 1},
                               {1, 1},
                               {3, 0},
                               {2, 1},
                               {1, 2},
                               {3, 1},
                               {5, 0},
                               {4, 1},
                               {3, 2},
                               {2, 3},
                               {0, 5}}) {
        EXPECT_NEAR(mean(a, b), 0, kCurvature) << a << ' ' << b;
    }
}

TEST(SourceDisc, SevenPointsMatchTheFineReferenceOnASharpLobe) {
    const Direction middle = Direction::fromSpherical(40_deg, 0_deg);
    const auto surface = *proc::makeModel("ggx,alpha=0.02,f0=0.9");
    const double fine = fineMean(*surface, middle, 1_deg);
    EXPECT_NEAR(discMean(*surface, middle, 1_deg) / fine, 1, 1e-3);
    // And the disc does something there: the reference is off the point's f by more than that.
    const Direction out = Direction::fromSpherical(41_deg, 180_deg);
    const double point = surface->answer({.in = middle, .out = out}).f[Band::G];
    EXPECT_GT(std::abs(point / fine - 1), 5e-3);
}

}  // namespace
}  // namespace gonio::sim
