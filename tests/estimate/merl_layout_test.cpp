#include "proc/estimate/merl_layout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/estimate/lookup_pairs.h"
#include "tests/estimate/scatterers.h"

namespace gonio::proc {
namespace {

double worst(const Scatterer& truth, const MerlLayout& table, MerlLookup how) {
    double worst = 0;
    for (const LightView& pair : cosinePairs({20000, 4})) {
        const double f = table.evaluate(pair, how)[Band::G];
        if (std::isnan(f)) continue;  // the nearest node may lie below the horizon
        worst = std::max(worst, std::abs(f / truth.answer(pair).f[Band::G] - 1));
    }
    return worst;
}

TEST(MerlLayout, IsExactForAConstantAndSilentBelowTheHorizon) {
    const auto lambert = test::model("lambert,albedo=0.5/0.3/0.2");
    const MerlLayout table(*lambert);
    EXPECT_EQ(table.bytes(), 34'992'000U);
    for (const LightView& pair : cosinePairs({2000, 3})) {
        EXPECT_NEAR(table.evaluate(pair, MerlLookup::Trilinear)[Band::R], 0.5 / kPi, 1e-12);
    }
    const Direction below = *Direction::fromVector({1, 0, -0.1});
    EXPECT_TRUE(std::isnan(table.evaluate({below, {}}, MerlLookup::Nearest)[Band::R]));
}

TEST(MerlLayout, InterpolatingErrsLessThanTheNearestNode) {
    const auto truth = test::model("lambert,albedo=0.3+ggx,alpha=0.3,f0=0.04");
    const MerlLayout table(*truth);
    const double nearest = worst(*truth, table, MerlLookup::Nearest);
    const double trilinear = worst(*truth, table, MerlLookup::Trilinear);
    EXPECT_LT(trilinear, nearest);
    EXPECT_LT(nearest, 0.5);
}

}  // namespace
}  // namespace gonio::proc
