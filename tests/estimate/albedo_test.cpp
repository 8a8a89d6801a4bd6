#include "proc/estimate/albedo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "proc/estimate/seed_albedo.h"
#include "proc/models/directional_albedo.h"
#include "proc/solve/quadrature.h"
#include "tests/estimate/scatterers.h"
#include "tests/support/reference_csv.h"

namespace gonio::proc {
namespace {

using test::answerOf;
using test::Made;
using test::model;
using test::tilted;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(DirectionalAlbedoOfAScatterer, OfLambertIsItsAlbedoTo1e6) {
    const auto lambert = model("lambert,albedo=0.5/0.2/0");
    for (const double degrees : {0.0, 1e-5, 45.0, 85.0, 89.9}) {
        const Albedo albedo = directionalAlbedo(*lambert, tilted(degrees));
        EXPECT_NEAR(albedo[Band::R].value, 0.5, 1e-6) << degrees;
        EXPECT_NEAR(albedo[Band::G].value, 0.2, 1e-6) << degrees;
        EXPECT_EQ(albedo[Band::B].value, 0) << degrees;
        EXPECT_NEAR(albedo[Band::R].missing, 0, 1e-7) << degrees;
        EXPECT_TRUE(albedo.converged);
        EXPECT_FALSE(albedo[Band::R].u().has_value());
    }
}

TEST(DirectionalAlbedoOfAScatterer, OfGgxIsWithinItsBoundAnd1e4OfTheReference) {
    // 60-digit values of E at alpha 1e-3..1 and mu 1e-4..1.
    for (const auto& row : test::referenceTable("ggx_directional_albedo_dfg").rows) {
        const auto ggx = model("ggx,f0=1,alpha=" + std::to_string(row[0]));
        const double mu = row[1];
        const auto wi = Direction::fromVector({std::sqrt((1 - mu) * (1 + mu)), 0, mu});
        const Albedo albedo = directionalAlbedo(*ggx, *wi);
        // alpha as text has six decimals: 5e-5 of the smallest.
        const double error = std::abs(albedo[Band::G].value - row[2]);
        EXPECT_LT(error, 1e-4) << row[0] << " " << mu;
        EXPECT_LE(error, albedo[Band::G].errorBound + 5e-6) << row[0] << " " << mu;
    }
}

TEST(DirectionalAlbedoOfAScatterer, OfGgxMeetsItsTargetInAFewThousandEvaluations) {
    for (const double alpha : {0.01, 0.1, 1.0}) {
        const auto ggx = model("ggx,f0=1,alpha=" + std::to_string(alpha));
        for (const double degrees : {0.0, 20.0, 40.0, 60.0, 75.0, 85.0}) {
            const Direction wi = tilted(degrees);
            const Albedo albedo = directionalAlbedo(*ggx, wi);
            const double truth = ggxAlbedo({alpha, wi.z()}, Effort::Reference).e;
            EXPECT_NEAR(albedo[Band::R].value, truth, 1e-6) << alpha << " " << degrees;
            EXPECT_TRUE(albedo.converged) << alpha << " " << degrees;
            EXPECT_LE(albedo.evaluations, 12000U) << alpha << " " << degrees;
        }
    }
}

/// Over wo by a grid of many points, for lobes that it resolves.
double bruteForce(const Scatterer& of, const Direction& wi) {
    static const auto nodes = gaussLegendre(300);
    double sum = 0;
    for (const QuadratureNode& ring : nodes) {
        const Radians theta(kPi / 2 * ring.x);
        for (const QuadratureNode& sector : nodes) {
            const Direction wo = Direction::fromSpherical(theta, Radians(2 * kPi * sector.x));
            sum += of.answer({wi, wo}).f[Band::G] * sin(theta) * cos(theta) * kPi * kPi *
                   ring.weight * sector.weight;
        }
    }
    return sum;
}

TEST(DirectionalAlbedoOfAScatterer, TrueErrorIsWithinTheBoundForEveryFamily) {
    for (const char* spec : {"lambert,albedo=0.5",
                             "oren-nayar,albedo=0.5,sigma=0.5",
                             "disney-diffuse,albedo=0.5,roughness=0.8",
                             "cod-wwii-diffuse,albedo=0.5,alpha=0.3",
                             "phong,kd=0.2,ks=0.8,n=20",
                             "lafortune,cxy=0.9,cz=0.9,n=30",
                             "blinn-phong,kd=0.1,ks=0.4,n=50",
                             "ward,alpha_x=0.15,alpha_y=0.4,ks=0.9",
                             "cook-torrance,m=0.3,f0=0.9,ks=0.25",
                             "ggx,alpha_x=0.2,alpha_y=0.5,f0=0.9",
                             "beckmann,alpha=0.3,f0=1",
                             "walter,alpha=0.3,eta=1.5",
                             "lambert,albedo=0.3+ggx,alpha=0.3,f0=0.04"}) {
        const auto of = model(spec);
        for (const double degrees : {0.0, 40.0, 75.0}) {
            const Direction wi = tilted(degrees);
            const Albedo albedo = directionalAlbedo(*of, wi);
            // The grid of the comparison errs by some 1e-6 where f has a kink.
            EXPECT_NEAR(
                albedo[Band::G].value, bruteForce(*of, wi), albedo[Band::G].errorBound + 3e-6)
                << spec << " " << degrees;
        }
    }
}

TEST(DirectionalAlbedoOfAScatterer, ASmallerToleranceBringsValueAndBoundTogether) {
    const auto of = model("beckmann,alpha=0.02,f0=1+oren-nayar,albedo=0.5,sigma=0.5");
    const Albedo exact =
        directionalAlbedo(*of, tilted(60), {.tolerance = 1e-9, .mostEvaluations = 2'000'000});
    ASSERT_TRUE(exact.converged);
    double before = 1;
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
        const Albedo albedo = directionalAlbedo(
            *of, tilted(60), {.tolerance = tolerance, .mostEvaluations = 2'000'000});
        const double bound = albedo[Band::G].errorBound;
        EXPECT_LE(bound, tolerance);
        EXPECT_LT(bound, before);
        EXPECT_LE(std::abs(albedo[Band::G].value - exact[Band::G].value), bound);
        before = bound;
    }
}

TEST(DirectionalAlbedoOfAScatterer, SaysWhenItsEvaluationsRanOut) {
    const auto of = model("ggx,alpha=0.01,f0=1");
    const Albedo albedo =
        directionalAlbedo(*of, tilted(89), {.tolerance = 1e-12, .mostEvaluations = 8000});
    EXPECT_FALSE(albedo.converged);
    EXPECT_LE(albedo.evaluations, 8000U);
    EXPECT_GT(albedo[Band::G].errorBound, 1e-12);
}

TEST(DirectionalAlbedoOfAScatterer, MissingIsAShareAndNotADarkSurface) {
    // Answers to 75 degrees only: albedo 0.5 sin^2(75) of it was seen, cos^2(75) was not.
    const Made seen([](const LightView& pair) {
        const bool inside = pair.out.theta() < 75_deg;
        return answerOf(inside ? 0.5 / kPi : kNan);
    });
    const double share = std::pow(cos(75_deg), 2);
    const Albedo albedo = directionalAlbedo(seen, tilted(20));
    EXPECT_NEAR(albedo[Band::G].missing, share, 2 * albedo[Band::G].errorBound);
    EXPECT_NEAR(albedo[Band::G].value, 0.5 * (1 - share), albedo[Band::G].errorBound);
    EXPECT_LT(albedo[Band::G].errorBound, 1e-3);
    EXPECT_FALSE(albedo.converged) << "a jump is not resolved to 1e-5";
}

TEST(DirectionalAlbedoOfAScatterer, WithoutAnyAnswerIsNanAndAllMissing) {
    const Made silent([](const LightView&) { return answerOf(kNan); });
    for (const Direction& wi : {tilted(30), *Direction::fromVector({1, 0, -0.1})}) {
        const Albedo albedo = directionalAlbedo(silent, wi);
        EXPECT_TRUE(std::isnan(albedo[Band::R].value));
        EXPECT_EQ(albedo[Band::R].missing, 1);
    }
}

TEST(DirectionalAlbedoOfAScatterer, NegativeValuesAreKept) {
    const Made noise([](const LightView&) { return answerOf(-0.01 / kPi); });
    EXPECT_NEAR(directionalAlbedo(noise, tilted(30))[Band::R].value, -0.01, 1e-7);
}

TEST(DirectionalAlbedoOfAScatterer, RandomErrorFallsWithTheCellsAndTheSystematicOneDoesNot) {
    const Made uncertain([](const LightView&) {
        Answer answer = answerOf(0.5 / kPi);
        answer.uRandom = LedBands::all(0.01 / kPi);
        answer.uSystematic = LedBands::all(0.02 / kPi);
        return answer;
    });
    const BandAlbedo albedo = directionalAlbedo(uncertain, tilted(30))[Band::G];
    // integral of cos^2 dw = 2 pi / 3 of the hemisphere.
    EXPECT_NEAR(*albedo.uRandom, 0.01 / kPi * std::sqrt(kSquareDegree * 2 * kPi / 3), 1e-7);
    EXPECT_NEAR(*albedo.uSystematic, 0.02, 1e-7);
    EXPECT_NEAR(*albedo.u(), std::hypot(*albedo.uRandom, *albedo.uSystematic), 1e-15);
}

TEST(MeanAlbedo, OfLambertAndGgxIsWithinItsBound) {
    EXPECT_NEAR(meanAlbedo(*model("lambert,albedo=0.5"))[Band::G].value, 0.5, 1e-6);
    for (const double alpha : {0.05, 0.3, 1.0}) {
        const auto ggx = model("ggx,f0=1,alpha=" + std::to_string(alpha));
        const Albedo mean = meanAlbedo(*ggx);
        const double error =
            std::abs(mean[Band::G].value - ggxAverageAlbedo(alpha, Effort::Reference).e);
        EXPECT_LT(error, 1e-5) << alpha;
        EXPECT_LE(error, mean[Band::G].errorBound) << alpha;
        EXPECT_TRUE(mean.converged);
    }
}

TEST(MeanAlbedo, HasConvergedWhereItsWholeErrorBoundMeetsTheTolerance) {
    // Each directional integral ends at a bound of some 1e-5, the same at all incidences: the outer
    // integral alone would be right to 1e-6.
    const Made seen([](const LightView& pair) {
        return answerOf(pair.out.theta() < 75_deg ? 0.5 / kPi : kNan);
    });
    const AlbedoOptions few{.tolerance = 1e-9, .mostEvaluations = 5400};
    for (const double tolerance : {1e-5, 1e-4, 1e-3, 1e-2, 0.1}) {
        const Albedo mean =
            meanAlbedo(seen, {.directional = few, .tolerance = tolerance, .mostIncidences = 15});
        EXPECT_EQ(mean.converged, mean[Band::G].errorBound <= tolerance) << tolerance;
    }
}

TEST(MeanAlbedo, AveragesOverAzimuthsWhereASurfaceHasAGrain) {
    // f grows with the azimuth of the light about x: the mean over it is known, one azimuth's is
    // not it.
    const Made grain([](const LightView& pair) {
        const double s2 = pair.in.x() * pair.in.x() + pair.in.y() * pair.in.y();
        const double cos2Phi = s2 > 0 ? pair.in.x() * pair.in.x() / s2 : 0.5;
        return answerOf(cos2Phi / kPi);
    });
    EXPECT_NEAR(meanAlbedo(grain)[Band::G].value, 1, 1e-5);
    EXPECT_NEAR(meanAlbedo(grain, {.azimuths = 4})[Band::G].value, 0.5, 1e-5);
}

TEST(MeanAlbedo, CountsIncidencesWithoutAnAnswerAsMissing) {
    const Made steep([](const LightView& pair) {
        return answerOf(pair.in.theta() < 60_deg ? 0.5 / kPi : kNan);
    });
    const Albedo mean = meanAlbedo(steep);
    EXPECT_NEAR(mean[Band::G].missing, 0.25, 5e-3);
    EXPECT_NEAR(mean[Band::G].value, 0.375, mean[Band::G].errorBound);
}

TEST(RiemannAlbedo, MissesWhatLiesBeyondItsGridAndCannotSeeANarrowLobe) {
    const auto lambert = model("lambert,albedo=0.5");
    const double seen = 0.5 * std::pow(sin(75_deg), 2);
    EXPECT_NEAR(riemannAlbedo(*lambert, tilted(20))[Band::G], seen, 5e-3);
    EXPECT_GT(std::abs(riemannAlbedo(*lambert, tilted(20))[Band::G] - seen), 1e-3)
        << "the last ring is counted in full";
    const auto sharp = model("ggx,alpha=0.001,f0=1");
    EXPECT_GT(std::abs(riemannAlbedo(*sharp, tilted(40, 0.0))[Band::G] - 1), 0.1);
}

}  // namespace
}  // namespace gonio::proc
