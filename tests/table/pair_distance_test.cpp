#include "proc/table/pair_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

LightView randomPair(std::mt19937_64& random) {
    return {.in = test::randomDirection(random), .out = test::randomDirection(random)};
}

LightView turned(const LightView& pair, Radians angle) {
    return {.in = pair.in.turned(angle), .out = pair.out.turned(angle)};
}

LightView mirrored(const LightView& pair) {
    const auto flip = [](const Direction& d) {
        return *Direction::fromVector({d.x(), -d.y(), d.z()});
    };
    return {.in = flip(pair.in), .out = flip(pair.out)};
}

Direction at(Radians theta, Radians phi = Radians(0)) {
    return Direction::fromSpherical(theta, phi);
}

double distance(const LightView& a, const LightView& b, PairSymmetry symmetry) {
    return std::sqrt(squaredDistance(a, b, symmetry));
}

TEST(PairDistance, IsThatOfTheSixComponents) {
    const LightView a{at(0_deg), at(0_deg)};
    const LightView b{at(90_deg), at(90_deg, 90_deg)};
    EXPECT_NEAR(distance(a, b, PairSymmetry::None), 2, 1e-15);
    EXPECT_NEAR(distance({at(0_deg), at(30_deg)}, {at(0_deg), at(31_deg)}, PairSymmetry::None),
                2 * std::sin((0.5_deg).value()),
                1e-15);
}

TEST(PairDistance, IsTheLeastOverAllCommonTurnsAndMirrors) {
    std::mt19937_64 random(11);
    constexpr int kTurns = 3600;
    for (int i = 0; i < 100; ++i) {
        const LightView a = randomPair(random);
        const LightView b = randomPair(random);
        double turns = 8, mirrors = 8;
        for (int k = 0; k < kTurns; ++k) {
            const Radians angle(2 * kPi * k / kTurns);
            turns = std::min(turns, distance(turned(a, angle), b, PairSymmetry::None));
            mirrors =
                std::min(mirrors, distance(turned(mirrored(a), angle), b, PairSymmetry::None));
        }
        mirrors = std::min(mirrors, turns);
        // A turn is off by half a step at most: 8.7e-4 of each of two components of length 1; what
        // that adds to a squared distance is at most 2 x 7.6e-7, as the least is stationary.
        const auto expectLeast = [](double least, double scanned) {
            EXPECT_LE(least, scanned + 1e-12);
            EXPECT_GE(least * least, scanned * scanned - 2e-6);
        };
        expectLeast(distance(a, b, PairSymmetry::Isotropic), turns);
        expectLeast(distance(a, b, PairSymmetry::Plane), mirrors);
    }
}

TEST(PairDistance, IsZeroForEqualPairsAlone) {
    std::mt19937_64 random(12);
    for (int i = 0; i < 1000; ++i) {
        const LightView a = randomPair(random);
        const LightView b = turned(a, Radians(0.1 + i));
        EXPECT_EQ(squaredDistance(a, a, PairSymmetry::None), 0);
        EXPECT_EQ(squaredDistance(a, a, PairSymmetry::Isotropic), 0);
        EXPECT_NEAR(distance(a, b, PairSymmetry::Isotropic), 0, 1e-15);
        EXPECT_NEAR(distance(mirrored(a), b, PairSymmetry::Plane), 0, 1e-15);
        EXPECT_GT(distance(a, randomPair(random), PairSymmetry::Plane), 1e-6);
    }
    const LightView left{at(30_deg), at(40_deg, 90_deg)};
    EXPECT_GT(distance(left, mirrored(left), PairSymmetry::Isotropic), 0.3);
}

TEST(PairDistance, DoesNotMindTheAzimuthOfTheNormal) {
    for (const PairSymmetry symmetry : {PairSymmetry::Isotropic, PairSymmetry::Plane}) {
        const LightView normal{at(0_deg), at(40_deg, 10_deg)};
        EXPECT_NEAR(distance(normal, {at(0_deg), at(40_deg, 250_deg)}, symmetry), 0, 1e-15);
        EXPECT_NEAR(
            distance({at(10_deg), at(0_deg)}, {at(10_deg, 70_deg), at(0_deg)}, symmetry), 0, 1e-15);
        EXPECT_EQ(distance({at(0_deg), at(0_deg)}, {at(0_deg), at(0_deg)}, symmetry), 0);
    }
}

TEST(PairDistance, IsContinuousAtTheNormal) {
    // Next to the normal two azimuths of wi are as near to each other as wi is to the normal.
    const Radians tiny(1e-6);
    const LightView one{at(tiny, 0_deg), at(40_deg)};
    const LightView other{at(tiny, 120_deg), at(40_deg)};
    EXPECT_LE(distance(one, other, PairSymmetry::Isotropic), 2e-6);
    EXPECT_GT(distance(one, other, PairSymmetry::Isotropic), 1e-6);
}

TEST(PairDistance, KeepsTheTriangleInequality) {
    std::mt19937_64 random(13);
    for (int i = 0; i < 10'000; ++i) {
        const LightView a = randomPair(random);
        const LightView b = randomPair(random);
        const LightView c = randomPair(random);
        for (const PairSymmetry s : {PairSymmetry::Isotropic, PairSymmetry::Plane}) {
            EXPECT_LE(distance(a, c, s), distance(a, b, s) + distance(b, c, s) + 1e-14);
        }
    }
}

double placeDistance(const LightView& a, const LightView& b, PairSymmetry symmetry) {
    const PairPlace p = placeOf(a, symmetry);
    const PairPlace q = placeOf(b, symmetry);
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) sum += (p[i] - q[i]) * (p[i] - q[i]);
    return std::sqrt(sum);
}

TEST(PairPlace, IsNeverFartherThanThePairs) {
    std::mt19937_64 random(14);
    for (int i = 0; i < 20'000; ++i) {
        const LightView a = randomPair(random);
        // Half of them near: there the two are nearly the same.
        const LightView far = randomPair(random);
        const Eigen::Vector3d towards = 1e-3 * far.out.vector();
        const LightView near{.in = *Direction::fromVector(a.in.vector() + towards),
                             .out = *Direction::fromVector(a.out.vector() - towards)};
        for (const PairSymmetry s :
             {PairSymmetry::None, PairSymmetry::Isotropic, PairSymmetry::Plane}) {
            const double apart = distance(a, far, s);
            const double places = placeDistance(a, far, s);
            EXPECT_LE(places, apart + 1e-14);
            EXPECT_GE(places, apart / std::sqrt(2.0) - 1e-14);
            EXPECT_LE(placeDistance(a, near, s), distance(a, near, s) + 1e-14);
        }
    }
}

TEST(PairPlace, IsTheSameForEqualPairs) {
    std::mt19937_64 random(15);
    for (int i = 0; i < 1000; ++i) {
        const LightView a = randomPair(random);
        const Radians angle(0.1 + i);
        EXPECT_NEAR(placeDistance(a, turned(a, angle), PairSymmetry::Isotropic), 0, 1e-15);
        EXPECT_NEAR(placeDistance(a, turned(mirrored(a), angle), PairSymmetry::Plane), 0, 1e-15);
    }
}

}  // namespace
}  // namespace gonio::proc
