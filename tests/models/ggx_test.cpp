#include "proc/models/ggx.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/reference_csv.h"

namespace gonio::proc {
namespace {

constexpr double kRelative = 4e-15;  // a few roundings of double

void expectRelative(double seen, double wanted, double tolerance) {
    EXPECT_LE(std::abs(seen - wanted), tolerance * std::abs(wanted)) << seen << " for " << wanted;
}

TEST(GgxModel, DistributionMatchesSixtyDigits) {
    for (const auto& row : test::referenceRows("d_ggx")) {
        const Eigen::Vector3d half(std::sqrt(row[1]), 0, std::sqrt(1 - row[1]));
        // sin^2 as given decides; cos^2 = 1 - sin^2 is exact enough only away from grazing.
        const double tolerance = row[1] < 0.99 ? kRelative : 1e-9;
        expectRelative(ggxD(half, {row[0], row[0]}), row[2], tolerance);
    }
}

TEST(GgxModel, AnisotropicFormsMatchSixtyDigits) {
    for (const auto& row : test::referenceRows("d_lambda_ggx_aniso")) {
        const auto w = Direction::fromVector({row[2], row[3], row[4]});
        ASSERT_TRUE(w);
        expectRelative(ggxD(w->vector(), {row[0], row[1]}), row[5], 1e-13);
        expectRelative(ggxLambda(*w, {row[0], row[1]}), row[6], 1e-13);
    }
}

TEST(GgxModel, VisibilityMatchesSixtyDigits) {
    for (const auto& row : test::referenceRows("visibility_ggx")) {
        const auto at = [](double mu) {
            return Direction::fromVector({std::sqrt((1 - mu) * (1 + mu)), 0, mu}).value();
        };
        const LightView pair{at(row[1]), at(row[2])};
        expectRelative(ggxV(pair, {row[0], row[0]}, Masking::HeightCorrelated), row[3], 1e-13);
        expectRelative(ggxV(pair, {row[0], row[0]}, Masking::Separable), row[4], 1e-13);
    }
}

TEST(GgxModel, SchlickMatchesSixtyDigits) {
    for (const auto& row : test::referenceRows("fresnel_schlick")) {
        if (row[1] != 1) continue;
        expectRelative(schlick(LedBands::all(row[0]), row[2]).value[0], row[3], 1e-14);
    }
}

TEST(GgxModel, PeakAtNormalIncidenceIsF0OverFourPiAlphaSquared) {
    for (double alpha : {1e-7, 1e-3, 0.1, 1.0}) {
        const Ggx model({alpha, alpha}, LedBands::all(0.5), Masking::HeightCorrelated);
        const double f = model.answer({Direction(), Direction()}).f.value[0];
        expectRelative(f, 0.5 / (4 * kPi * alpha * alpha), 1e-14);
    }
}

TEST(GgxModel, SmallLambdaKeepsItsDigits) {
    const Direction w = Direction::fromSpherical(Radians(1e-6), Radians(0));
    const double x = 1e-6 * 1e-6 * 1e-12;  // (alpha tan)^2, alpha 1e-6
    expectRelative(ggxLambda(w, {1e-6, 1e-6}), x / 4, 1e-10);
}

TEST(GgxModel, DistributionProjectsOntoTheWholeSurface) {
    // Integral of D cos(theta) over the hemisphere is 1. With t = tan^2(theta) / alpha^2 the
    // isotropic integrand is dt / (1 + t)^2, so u = t / (1 + t) makes it constant: midpoints of u
    // and of phi are exact up to rounding; the anisotropic one is smooth in phi.
    for (const GgxAlpha alpha : {GgxAlpha{0.01, 0.01}, GgxAlpha{0.5, 0.5}, GgxAlpha{0.2, 0.6}}) {
        constexpr int kSteps = 400;
        const double scale = std::sqrt(alpha.x * alpha.y);
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double u = (i + 0.5) / kSteps;
            const double tangent = scale * std::sqrt(u / (1 - u));
            const double c = 1 / std::sqrt(1 + tangent * tangent);
            // cos dOmega = c^4 tan d(tan) dphi, tan d(tan) = scale^2 / 2 du / (1 - u)^2.
            const double weight = std::pow(c, 4) * scale * scale / 2 / ((1 - u) * (1 - u));
            for (int j = 0; j < kSteps; ++j) {
                const double phi = (j + 0.5) * 2 * kPi / kSteps;
                const double s = tangent * c;
                sum += ggxD({s * std::cos(phi), s * std::sin(phi), c}, alpha) * weight * 2 * kPi /
                       (kSteps * kSteps);
            }
        }
        // The last step of u leaves a corner of order 1 / steps^2 where the lobe is anisotropic.
        EXPECT_NEAR(sum, 1, 1e-4) << alpha.x << " " << alpha.y;
    }
}

TEST(GgxModel, DistributionDoesNotDependOnTheLengthOfTheHalfVector) {
    const Eigen::Vector3d half(0.1, -0.2, 0.9);
    for (double length : {1e-3, 2.0, 1e5})
        expectRelative(ggxD(length * half, {0.1, 0.3}), ggxD(half, {0.1, 0.3}), kRelative);
}

TEST(GgxModel, LambdaIsZeroAtTheNormalAndGrowsTowardGrazing) {
    for (double alpha : {1e-7, 0.1, 1.0}) {
        EXPECT_EQ(ggxLambda(Direction(), {alpha, alpha}), 0);
        double before = 0;
        for (double theta = 5; theta < 90; theta += 5) {
            const Direction w = Direction::fromSpherical(Radians::fromDegrees(theta), 0_deg);
            EXPECT_GT(ggxLambda(w, {alpha, alpha}), before);
            before = ggxLambda(w, {alpha, alpha});
        }
    }
}

TEST(GgxModel, SeparableMaskingIsNeverTheBrighter) {
    for (double in : {0.0, 40.0, 80.0, 89.9}) {
        for (double out : {0.0, 40.0, 80.0, 89.9}) {
            const LightView pair{Direction::fromSpherical(Radians::fromDegrees(in), 0_deg),
                                 Direction::fromSpherical(Radians::fromDegrees(out), 90_deg)};
            const double together = ggxV(pair, {0.5, 0.5}, Masking::HeightCorrelated);
            EXPECT_LE(ggxV(pair, {0.5, 0.5}, Masking::Separable), together * (1 + kRelative));
            EXPECT_TRUE(std::isfinite(together));
        }
    }
}

TEST(GgxModel, SchlickGoesFromF0AtTheNormalToOneAtGrazing) {
    const LedBands f0{{0, 0.04, 1}};
    EXPECT_EQ(schlick(f0, 1), f0);
    EXPECT_EQ(schlick(f0, 0), LedBands::all(1));
    EXPECT_DOUBLE_EQ(schlick(f0, 0.5)[Band::G], 0.04 + 0.96 / 32);
}

TEST(GgxModel, ARoughWhiteMetalKeepsOneMinusLnTwo) {
    // Midpoint rule over s = sin^2(theta) at normal incidence, where f is isotropic in phi.
    const Ggx metal({1, 1}, LedBands::all(1), Masking::HeightCorrelated);
    constexpr int kRings = 20000;
    double energy = 0;
    for (int i = 0; i < kRings; ++i) {
        const Radians theta(std::asin(std::sqrt((i + 0.5) / kRings)));
        energy += metal.answer({Direction(), Direction::fromSpherical(theta, 0_deg)}).f.value[0] *
                  kPi / kRings;
    }
    EXPECT_NEAR(energy, 1 - std::log(2.0), 1e-5);
}

}  // namespace
}  // namespace gonio::proc
