#include "proc/estimate/grid_linear.h"

#include <cmath>
#include <random>

#include "proc/core/coordinates.h"
#include "tests/estimate/made_up.h"

namespace gonio::proc {
namespace {

using test::Everywhere;
using test::made;
using test::pairAt;

const std::vector<Radians> kPlanes{0_deg, 20_deg, 40_deg, 60_deg};

double closed(double phi) { return std::min(phi, 360 - phi); }

double linear(double i, double o, double phi) {
    return 2 + 0.01 * i - 0.02 * o + 0.003 * closed(phi);
}

/// Linear in the specular-relative coordinates, for the light at phi = 0.
double linearAboutMirror(double i, double o, double phi) {
    const SpecularRelative at = toSpecularRelative(pairAt(i, o, phi));
    return 3 + 0.01 * i - 0.01 * at.radial.degrees() + 0.003 * closed(at.azimuth.degrees());
}

std::unique_ptr<Scatterer> up(const test::OfAngles& f) {
    return made(makeGridLinear(
        Everywhere(f),
        {.incidences = kPlanes, .origin = GridOrigin::Up, .rows = 19, .columns = 24}));
}

std::unique_ptr<Scatterer> specular(const test::OfAngles& f) {
    return made(makeGridLinear(
        Everywhere(f),
        {.incidences = kPlanes, .origin = GridOrigin::Specular, .rows = 37, .columns = 24}));
}

TEST(GridLinear, ReproducesWhatIsLinearInTheAnglesWithOriginUp) {
    const auto grid = up(linear);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int k = 0; k < 2000; ++k) {
        const double i = 60 * unit(random), phi = 360 * unit(random);
        const double o = 5 + 80 * unit(random);  // a pole's azimuth is any
        const Radians turn(2 * kPi * unit(random));
        const LightView pair = pairAt(i, o, phi);
        const Answer answer = grid->answer({pair.in.turned(turn), pair.out.turned(turn)});
        EXPECT_NEAR(answer.f[Band::R], linear(i, o, phi), 1e-12);
        EXPECT_NEAR((*answer.uSystematic)[Band::R], 0.05 * answer.f[Band::R], 1e-12);
        EXPECT_EQ(answer.source, Source::Interpolated);
    }
}

TEST(GridLinear, ReproducesWhatIsLinearAboutTheMirrorDirectionWithOriginSpecular) {
    const auto grid = specular(linearAboutMirror);
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> unit(0, 1);
    int seen = 0;
    for (int k = 0; k < 2000; ++k) {
        const double i = 60 * unit(random), o = 60 * unit(random), phi = 360 * unit(random);
        const SpecularRelative at = toSpecularRelative(pairAt(i, o, phi));
        // In the first ring the mirror direction's azimuth counts; past 25 degrees on the far side
        // nodes may lie below the horizon.
        if (at.radial < 5_deg || at.radial > 25_deg) continue;
        ++seen;
        EXPECT_NEAR(
            grid->answer(pairAt(i, o, phi)).f[Band::R], linearAboutMirror(i, o, phi), 1e-12);
    }
    EXPECT_GT(seen, 100);
}

TEST(GridLinear, ReproducesAConstantToTheHorizon) {
    const auto constant = [](double, double, double) { return 0.25; };
    for (const auto& grid : {up(constant), specular(constant)}) {
        for (double o = 0; o <= 80; o += 1.7) {
            for (double phi = 0; phi < 360; phi += 13) {
                const Answer answer = grid->answer(pairAt(33, o, phi));
                if (!answer.present()) continue;
                EXPECT_NEAR(answer.f[Band::R], 0.25, 1e-14);
            }
        }
        EXPECT_TRUE(grid->answer(pairAt(33, 70, 180)).present());
    }
}

TEST(GridLinear, KeepsALobeAtTheMirrorDirectionOnlyWithOriginSpecular) {
    const auto lobe = [](double i, double o, double phi) {
        const double radial = toSpecularRelative(pairAt(i, o, phi)).radial.degrees();
        return 1 + 100 * std::exp(-radial * radial / 50);
    };
    const LightView mirror = pairAt(30, 30, 180);
    EXPECT_NEAR(specular(lobe)->answer(mirror).f[Band::R], 101, 1e-9);
    EXPECT_LT(up(lobe)->answer(mirror).f[Band::R], 30);
}

TEST(GridLinear, AnswersANodeAsItWasAnswered) {
    const Answer answer = up(linear)->answer(pairAt(40, 35, 30));
    EXPECT_NEAR(answer.f[Band::R], linear(40, 35, 30), 1e-12);
    EXPECT_EQ(answer.source, Source::Measured);
    EXPECT_EQ(answer.flags, (Flags{Flag::Measured, Flag::GlareCorrected}));
}

TEST(GridLinear, AnswersNothingOutsideThePlanesAndBelowTheHorizon) {
    const auto grid = up(linear);
    EXPECT_TRUE(grid->answer(pairAt(60, 30)).present());
    EXPECT_FALSE(grid->answer(pairAt(60.1, 30)).present());
    EXPECT_TRUE(grid->answer(pairAt(0, 0)).present());
    EXPECT_TRUE(grid->answer(pairAt(20, 90)).present());
    EXPECT_EQ(grid->answer(pairAt(20, 91)).flags, Flags{Flag::BelowHorizon});
}

TEST(GridLinear, NeedsHalfOfTheWeight) {
    /// Nothing beyond 40 degrees.
    class Narrow : public Everywhere {
    public:
        using Everywhere::Everywhere;
        [[nodiscard]] Answer answer(const LightView& pair) const override {
            const bool inside = pair.out.theta() < 40.5_deg;
            return inside ? Everywhere::answer(pair) : Answer::none({}, Source::Interpolated);
        }
    };
    const auto grid = made(makeGridLinear(
        Narrow(linear),
        {.incidences = kPlanes, .origin = GridOrigin::Up, .rows = 19, .columns = 24}));
    // Between the rows of 40 and 45 degrees.
    EXPECT_NEAR(grid->answer(pairAt(20, 42, 15)).f[Band::R], linear(20, 40, 15), 1e-12);
    EXPECT_FALSE(grid->answer(pairAt(20, 43, 15)).present());
    const auto none = made(makeGridLinear(test::Nowhere(), {.incidences = kPlanes}));
    EXPECT_FALSE(none->answer(pairAt(20, 10)).present());
}

TEST(GridLinear, RefusesOptionsOutOfTheirDomain) {
    const Everywhere inner(linear);
    for (const GridLinearOptions& bad :
         {GridLinearOptions{},
          GridLinearOptions{.incidences = {20_deg, 20_deg}},
          GridLinearOptions{.incidences = {90_deg}},
          GridLinearOptions{.incidences = {Radians(std::nan(""))}},
          GridLinearOptions{.incidences = kPlanes, .rows = 1},
          GridLinearOptions{.incidences = kPlanes, .columns = 0},
          GridLinearOptions{.incidences = kPlanes, .rows = 10'000, .columns = 10'000}}) {
        test::expectUsageError(makeGridLinear(inner, bad));
    }
}

}  // namespace
}  // namespace gonio::proc
