#include "proc/estimate/lobe_box.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "proc/core/coordinates.h"
#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

BoxPoint<float> pointOf(const LightView& pair) { return boxPoint(pairOf<double>(pair)); }

TEST(LobeBox, PointsAreTheAnglesTheyStandFor) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) {
        const LightView pair{test::randomDirection(random), test::randomDirection(random)};
        const BoxPoint<float> point = pointOf(pair);
        const auto angles = toHalfDifference(pair);
        const double t = tan(angles->thetaHalf);
        EXPECT_NEAR(point.tanHalf, t, 1e-6 * (1 + t));
        EXPECT_NEAR(point.cosDiff, cos(angles->thetaDiff), 1e-6);
        const double product = t * tan(angles->thetaDiff);
        const double q = std::abs(pair.in.z() - pair.out.z()) / (pair.in.z() + pair.out.z());
        const double skew = product < 1 ? std::abs(cos(angles->phiDiff)) : q;
        // q keeps 1e-7 of cosines; over a small product less is left, where c matters less.
        EXPECT_NEAR(point.skew, skew, 1e-6 + 1e-6 / product);
    }
}

TEST(LobeBox, DoesNotChangeWhenAPairIsTurnedMirroredOrSwapped) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 2000; ++i) {
        const LightView pair{test::randomDirection(random), test::randomDirection(random)};
        const auto mirrored = [](const Direction& w) {
            return *Direction::fromVector({w.x(), -w.y(), w.z()});
        };
        const BoxPoint<float> point = pointOf(pair);
        for (const LightView& same :
             {LightView{pair.in.turned(Radians(1.1)), pair.out.turned(Radians(1.1))},
              LightView{mirrored(pair.in), mirrored(pair.out)},
              LightView{pair.out, pair.in}}) {
            const BoxPoint<float> other = pointOf(same);
            EXPECT_NEAR(other.tanHalf, point.tanHalf, 1e-5 * (1 + point.tanHalf));
            EXPECT_NEAR(other.cosDiff, point.cosDiff, 1e-6);
            EXPECT_NEAR(other.skew, point.skew, 1e-4);
        }
    }
}

TEST(LobeBox, PlacesOfNodesAreTheNodes) {
    const BoxAxes axes({40, 12, 7}, 0.03);
    for (int i = 0; i < 40; ++i) {
        for (int j = 0; j < 12; ++j) {
            for (int k = 0; k < 7; ++k) {
                const BoxPoint<double> at = axes.pointAt({double(i), double(j), double(k)});
                const BoxPlace place = axes.placeOf({static_cast<float>(at.tanHalf),
                                                     static_cast<float>(at.cosDiff),
                                                     static_cast<float>(at.skew)});
                const int c = place.node % 7, m = place.node / 7 % 12, t = place.node / 84;
                EXPECT_NEAR(t + double{place.tanHalf}, i, 1e-4);
                EXPECT_NEAR(m + double{place.cosDiff}, j, 1e-4);
                EXPECT_NEAR(c + double{place.skew}, k, 1e-4);
            }
        }
    }
}

TEST(LobeBox, NoNumberLeadsOutsideTheTable) {
    const BoxAxes axes({4, 3, 2}, 0.1);
    const float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float t : {0.0F, 1e-30F, 1.0F, 115.0F, 1e30F, infinity, nan, -1.0F}) {
        for (const float m : {0.0F, 0.5F, 1.0F, 1.001F, nan}) {
            for (const float c : {0.0F, 1.0F, 7.0F, infinity, nan}) {
                const BoxPlace place = axes.placeOf({t, m, c});
                EXPECT_GE(place.node, 0);
                // The cell's far corner is one node further along each axis.
                EXPECT_LT(place.node + (3 + 1) * 2 + 1, 4 * 3 * 2) << t << " " << m << " " << c;
            }
        }
    }
}

}  // namespace
}  // namespace gonio::proc
