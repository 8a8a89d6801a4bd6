#include "sim/band_mixture.h"

#include <gtest/gtest.h>

#include "proc/models/spec.h"

namespace gonio::sim {
namespace {

TEST(BandMixture, WithoutCrosstalkItIsFItself) {
    const LedBands f{{0.3, 0.1, 0.07}};
    EXPECT_EQ(bandMixture(f, 0), f);
}

TEST(BandMixture, EachBandTakesItsShareFromItsNeighbours) {
    constexpr double c = 0.01;
    constexpr double kUlps = 1e-16;
    const LedBands red = bandMixture({{1, 0, 0}}, c);
    EXPECT_NEAR(red[Band::R], 1 - c, kUlps);
    EXPECT_NEAR(red[Band::G], c / 2, kUlps);
    EXPECT_EQ(red[Band::B], 0);
    const LedBands green = bandMixture({{0, 1, 0}}, c);
    EXPECT_NEAR(green[Band::R], c, kUlps);
    EXPECT_NEAR(green[Band::G], 1 - c, kUlps);
    EXPECT_NEAR(green[Band::B], c, kUlps);
    const LedBands blue = bandMixture({{0, 0, 1}}, c);
    EXPECT_EQ(blue[Band::R], 0);
    EXPECT_NEAR(blue[Band::G], c / 2, kUlps);
    EXPECT_NEAR(blue[Band::B], 1 - c, kUlps);
}

TEST(BandMixture, BandsThatAreAlikeStaySo) {
    EXPECT_EQ(bandMixture(LedBands::all(0.3), 0.2), LedBands::all(0.3));
}

TEST(MixedBands, AreTheSurfacesMixtureWhereItAnswers) {
    const std::shared_ptr<const Scatterer> surface = *proc::makeModel("lambert,albedo=0.9/0.3/0.1");
    const MixedBands mixed(surface, 0.1);
    const LightView pair{Direction::fromSpherical(20_deg, 0_deg), Direction()};
    EXPECT_EQ(mixed.answer(pair).f, bandMixture(surface->answer(pair).f, 0.1));
    EXPECT_NE(mixed.answer(pair).f, surface->answer(pair).f);
    const LightView below{pair.in, Direction::fromSpherical(100_deg, 0_deg)};
    EXPECT_FALSE(mixed.answer(below).present());
    EXPECT_EQ(mixed.answer(below).flags, surface->answer(below).flags);
    EXPECT_EQ(mixed.bandCount(), surface->bandCount());
}

}  // namespace
}  // namespace gonio::sim
