#include "sim/surface_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/models/spec.h"
#include "sim/band_mixture.h"

namespace gonio::sim {
namespace {

std::shared_ptr<const Scatterer> model(const char* spec) { return *proc::makeModel(spec); }

const std::shared_ptr<const Scatterer>& shiny() {
    static const auto made = model("lambert,albedo=0.2/0.1/0.05+ggx,alpha=0.05,f0=0.04");
    return made;
}

Placement sample(const SampleErrors& errors = {}, const Wedge& wedge = {}) {
    return {.role = Role::Sample, .surface = shiny(), .wedge = wedge, .errors = errors};
}

/// Where the light of an LED is brightest, along a meridian of the field; degrees from the normal
/// toward phi = 180 degrees.
double brightestDegrees(const SurfaceLight& light) {
    double best = 0, at = 0;
    for (double degrees = -75; degrees <= 75; degrees += 0.05) {
        const auto wo = Direction::fromSpherical(Radians::fromDegrees(degrees), 180_deg);
        const double f = light.towards(wo)[Band::G] / wo.z();
        if (f > best) {
            best = f;
            at = degrees;
        }
    }
    return at;
}

TEST(SurfaceLight, WithNothingWrongItIsExactlyFTimesTheCosine) {
    for (int led = 0; led < kLeds; ++led) {
        const SurfaceLight light(sample(), {}, led);
        for (double theta = 0; theta < 76; theta += 3.7) {
            const auto wo = Direction::fromSpherical(Radians::fromDegrees(theta), 130_deg);
            const Answer truth = shiny()->answer({ledDirection(led), wo});
            EXPECT_EQ(light.towards(wo), truth.f * wo.z());
        }
    }
}

TEST(SurfaceLight, ATiltMovesTheLobeByTwiceItsAngle) {
    for (int led : {0, 1, 2}) {
        const double flat = brightestDegrees(SurfaceLight(sample(), {}, led));
        const double tilted =
            brightestDegrees(SurfaceLight(sample({}, {.aboutY = 2_deg}), {}, led));
        // The rig's +x side goes down: the image moves toward phi = 0 by 4 degrees.
        EXPECT_NEAR(tilted - flat, -4, 0.1) << led;
    }
}

TEST(SurfaceLight, BelowTheTiltedSurfacesHorizonThereIsNothing) {
    const SurfaceLight light(sample({}, {.aboutY = 20_deg}), {}, 0);
    const auto at = [&](double degrees) {
        return light.towards(Direction::fromSpherical(Radians::fromDegrees(degrees), 180_deg));
    };
    EXPECT_GT(at(69)[Band::G], 0);
    EXPECT_EQ(at(71), LedBands{});
}

TEST(SurfaceLight, WavinessGivesEachLedsSpotAWedgeOfItsOwn) {
    const auto spots = waves(5, 1_deg);
    const Flaws flaws{.seed = 5};
    for (int led = 0; led < kLeds; ++led) {
        const SurfaceLight wavy(sample({.waviness = 1_deg}), flaws, led);
        const SurfaceLight tilted(sample({}, spots[static_cast<std::size_t>(led)]), flaws, led);
        for (double theta = 0; theta < 76; theta += 5) {
            const auto wo = Direction::fromSpherical(Radians::fromDegrees(theta), 160_deg);
            EXPECT_EQ(wavy.towards(wo), tilted.towards(wo)) << led << ' ' << theta;
        }
    }
}

TEST(SurfaceLight, ATranslucentSampleShowsItsBacking) {
    const auto wo = Direction::fromSpherical(30_deg, 45_deg);
    const double opaque = SurfaceLight(sample(), {}, 1).towards(wo)[Band::R];
    for (const Backing backing : {Backing::Black, Backing::White}) {
        const SampleErrors errors{.translucency = 0.2, .backing = backing};
        const double there = SurfaceLight(sample(errors), {}, 1).towards(wo)[Band::R];
        const double returned = backing == Backing::White ? 0.9 : 0.03;
        EXPECT_NEAR(there - opaque, 0.2 * returned / kPi * wo.z(), 1e-15);
    }
}

TEST(SurfaceLight, CrosstalkShowsTheMixtureOfTheBands) {
    const auto wo = Direction::fromSpherical(30_deg, 45_deg);
    const LedBands pure = SurfaceLight(sample(), {}, 2).towards(wo);
    const LedBands mixed = SurfaceLight(sample(), {.rig = {.crosstalk = 0.01}}, 2).towards(wo);
    for (Band b : kBands) EXPECT_NEAR(mixed[b], bandMixture(pure, 0.01)[b], 1e-16);
    EXPECT_LT(mixed[Band::R], pure[Band::R]);
}

TEST(SurfaceLight, AWideSourceLowersAndWidensASharpLobe) {
    const Placement sharp{
        .role = Role::Sample, .surface = model("ggx,alpha=0.02,f0=0.9"), .wedge = {}};
    const SurfaceLight point(sharp, {}, 2);
    const SurfaceLight disc(sharp, {.rig = {.sourceDiameter = 1_deg}}, 2);
    const auto peak = Direction::fromSpherical(40_deg, 180_deg);
    const auto flank = Direction::fromSpherical(43_deg, 180_deg);
    EXPECT_LT(disc.towards(peak)[Band::G], 0.99 * point.towards(peak)[Band::G]);
    EXPECT_GT(disc.towards(flank)[Band::G], 1.005 * point.towards(flank)[Band::G]);
}

/// Knows the LEDs' directions and no others, as a measured table does.
class LedsOnly : public Scatterer {
public:
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        for (int led = 0; led < kLeds; ++led) {
            if (pair.in.vector() == ledDirection(led).vector()) return {.f = {{0.3, 0.2, 0.1}}};
        }
        return Answer::none({}, Source::Interpolated);
    }
};

TEST(SurfaceLight, ATableOfTheLedsIsAskedForTheMiddleOfTheSourceOnly) {
    const Placement table{
        .role = Role::Sample, .surface = std::make_shared<const LedsOnly>(), .wedge = {}};
    const Direction wo = Direction::fromSpherical(20_deg, 10_deg);
    const LedBands point = SurfaceLight(table, {}, 3).towards(wo);
    const LedBands disc = SurfaceLight(table, {.rig = {.sourceDiameter = 1_deg}}, 3).towards(wo);
    for (Band b : kBands) EXPECT_NEAR(disc[b], point[b], 1e-16);
}

TEST(SurfaceLight, TheTilesLieFlatAndHaveNoneOfASamplesErrors) {
    const SampleErrors all{.waviness = 3_deg, .translucency = 0.5, .softness = 0.5};
    for (const Role role : {Role::White, Role::Black}) {
        Placement tile{.role = role, .surface = shiny(), .wedge = {}};
        const auto wo = Direction::fromSpherical(25_deg, 170_deg);
        const LedBands plain = SurfaceLight(tile, {}, 1).towards(wo);
        tile.wedge = {2_deg, 2_deg};
        tile.errors = all;
        EXPECT_EQ(SurfaceLight(tile, {}, 1).towards(wo), plain);
    }
}

TEST(SurfaceLight, APressedSamplesExcessIsAboutTheMirrorDirectionOfItsSpot) {
    const Wedge wedge{.aboutY = 3_deg};
    const SurfaceLight light(sample({.softness = 0.1}, wedge), {}, 1);
    EXPECT_NEAR(light.lobeShapeAt(mirrored(ledDirection(1), wedge)), 1, 1e-12);
    EXPECT_NEAR(light.lobeShapeAt(Direction::fromSpherical(24_deg, 180_deg)),
                lobeShape(10_deg),
                1e-9);  // the image is at 14 degrees
}

}  // namespace
}  // namespace gonio::sim
