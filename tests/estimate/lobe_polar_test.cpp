#include "proc/estimate/lobe_polar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proc/solve/quadrature.h"
#include "tests/estimate/scatterers.h"

namespace gonio::proc {
namespace {

using test::tilted;

TEST(LobePolar, HoldsTheWholeProjectedHemisphereAtEveryIncidence) {
    const auto nodes = gaussLegendre(24);
    for (const double degrees : {0.0, 1e-4, 30.0, 60.0, 85.0, 89.0, 89.9}) {
        const LobePolar polar(tilted(degrees));
        double sum = 0;
        for (int x = 0; x < LobePolar::kQuarters; ++x) {
            for (int y = 0; y < LobePolar::kRings; ++y) {
                for (const QuadratureNode& around : nodes) {
                    const Spoke spoke = polar.spoke(x + around.x);
                    for (const QuadratureNode& outward : nodes) {
                        sum += around.weight * outward.weight *
                               polar.at(spoke, LobePolar::ring(y + outward.x)).projected;
                    }
                }
            }
        }
        EXPECT_NEAR(sum, kPi, 1e-6) << degrees;
    }
}

TEST(LobePolar, StartsAtTheMirrorDirectionAndEndsAtTheHorizon) {
    for (const double degrees : {0.0, 40.0, 89.0}) {
        const Direction wi = tilted(degrees);
        const LobePolar polar(wi);
        for (const double x : {0.0, 0.7, 1.5, 2.2, 3.9}) {
            const Spoke spoke = polar.spoke(x);
            const Direction first = polar.at(spoke, LobePolar::ring(0)).wo;
            EXPECT_LT(angleBetween({first, mirrorOf(wi)}).degrees(), 1e-6);
            const ProjectedNode last = polar.at(spoke, LobePolar::ring(LobePolar::kRings));
            EXPECT_NEAR(last.wo.z(), 0, 1e-15);
            EXPECT_GT(last.wo.z(), 0);
        }
    }
}

TEST(LobePolar, KeepsTheSlopeOfTheHalfVector) {
    const Direction wi = tilted(50);
    const LobePolar polar(wi);
    for (const double x : {0.3, 1.2, 2.6, 3.4}) {
        for (const double y : {0.5, 2.5, 4.5, 5.9}) {
            const Spoke spoke = polar.spoke(x);
            const Ring ring = LobePolar::ring(y);
            const Eigen::Vector3d h = polar.at(spoke, ring).wo.vector() + wi.vector();
            const double t = spoke.tMax * ring.share;
            EXPECT_NEAR(std::hypot(h.x(), h.y()) / h.z(), t, 1e-12 + 1e-12 * t);
        }
    }
}

}  // namespace
}  // namespace gonio::proc
