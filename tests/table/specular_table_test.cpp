#include "proc/table/specular_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "proc/core/coordinates.h"

namespace gonio::proc {
namespace {

SpecularTable table() {
    SpecularTable t;
    t.symmetry = TableSymmetry::Asymmetrical4D;
    t.rotationDeg = {0, 90};
    t.incidenceDeg = {0, 30, 60};
    t.azimuthDeg = {0, 90, 180, 270, 360};
    t.radialDeg = {0, 20, 30, 60, 90};
    t.planes = {{.f = std::vector<double>(t.nodeCount(), 1), .tis = std::vector<double>(6, 1)}};
    return t;
}

/// Calls `visit` for each node, radial fastest.
template <class Visit>
void forEachNode(const SpecularTable& t, Visit visit) {
    TableNode n;
    for (n.rotation = 0; n.rotation < t.rotationDeg.size(); ++n.rotation) {
        for (n.incidence = 0; n.incidence < t.incidenceDeg.size(); ++n.incidence) {
            for (n.azimuth = 0; n.azimuth < t.azimuthDeg.size(); ++n.azimuth) {
                for (n.radial = 0; n.radial < t.radialDeg.size(); ++n.radial) visit(n);
            }
        }
    }
}

TEST(SpecularTable, IndexCountsNodesInTheOrderOfTheFile) {
    const SpecularTable t = table();
    EXPECT_EQ(t.nodeCount(), 150U);
    std::size_t next = 0;
    forEachNode(t, [&](TableNode n) { EXPECT_EQ(t.index(n), next++); });
    EXPECT_EQ(next, t.nodeCount());
    EXPECT_EQ(t.tisIndex({.rotation = 1, .incidence = 2, .azimuth = 3, .radial = 4}), 5U);
}

TEST(SpecularTable, IsEmptyWithoutAnyOfItsAxes) {
    EXPECT_EQ(SpecularTable{}.nodeCount(), 0U);
    SpecularTable t = table();
    t.azimuthDeg.clear();
    EXPECT_EQ(t.nodeCount(), 0U);
}

TEST(SpecularTable, APairHasTheCoordinatesOfItsNode) {
    const SpecularTable t = table();
    forEachNode(t, [&](TableNode n) {
        const LightView pair = t.pairAt(n);
        EXPECT_NEAR(pair.in.theta().degrees(), t.incidenceDeg[n.incidence], 1e-12);
        const auto at = toSpecularRelative(pair, -Radians::fromDegrees(t.rotationDeg[n.rotation]));
        EXPECT_NEAR(at.radial.degrees(), t.radialDeg[n.radial], 1e-12);
        if (n.radial == 0) return;  // no azimuth there
        const double apart = std::abs(at.azimuth.degrees() - t.azimuthDeg[n.azimuth]);
        EXPECT_NEAR(std::min(apart, 360 - apart), 0, 1e-11);
    });
}

TEST(SpecularTable, ARotationTurnsTheLightTheOtherWay) {
    const SpecularTable t = table();
    EXPECT_NEAR(t.pairAt({.rotation = 0, .incidence = 1}).in.phi().degrees(), 0, 1e-12);
    EXPECT_NEAR(t.pairAt({.rotation = 1, .incidence = 1}).in.phi().degrees(), 270, 1e-12);
    EXPECT_EQ(t.pairAt({.rotation = 1, .incidence = 0}).in.theta().value(), 0);
}

TEST(SpecularTable, HoldsDataOnlyAboveTheHorizon) {
    const SpecularTable t = table();
    forEachNode(t, [&](TableNode n) {
        const double z = t.pairAt(n).out.z();
        if (std::abs(z) > 1e-9) {
            EXPECT_EQ(t.canHoldData(n), z > 0);
        } else {
            EXPECT_FALSE(t.canHoldData(n)) << "on the horizon";
        }
        EXPECT_EQ(t.hasData(0, n), t.canHoldData(n));
    });
    // 60 degrees of incidence: away from the normal, 20 degrees are above and 30 on the horizon.
    EXPECT_TRUE(t.canHoldData({.incidence = 2, .azimuth = 2, .radial = 1}));
    EXPECT_FALSE(t.canHoldData({.incidence = 2, .azimuth = 2, .radial = 2}));
}

TEST(SpecularTable, ZeroAndNanAreNoDataAndANegativeValueIs) {
    SpecularTable t = table();
    const TableNode node{.incidence = 1, .azimuth = 1, .radial = 1};
    double& f = t.planes[0].f[t.index(node)];
    for (double none : {0.0, -0.0, std::numeric_limits<double>::quiet_NaN()}) {
        f = none;
        EXPECT_FALSE(t.hasData(0, node)) << none;
        EXPECT_TRUE(t.canHoldData(node));
    }
    f = -1e-5;
    EXPECT_TRUE(t.hasData(0, node));
}

}  // namespace
}  // namespace gonio::proc
