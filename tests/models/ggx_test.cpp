#include "proc/models/ggx.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/core/number_text.h"
#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

constexpr double kRelative = 4e-15;  // a few roundings of double

void expectRelative(double seen, double wanted, double tolerance) {
    EXPECT_LE(std::abs(seen - wanted), tolerance * std::abs(wanted)) << seen << " for " << wanted;
}

Alpha<double> isotropic(double alpha) { return Alpha<double>::isotropic(alpha); }

/// D about a half vector of any length.
double dOf(const Eigen::Vector3d& half, const Alpha<double>& alpha) {
    const Pair<double> pair{{half.x(), half.y(), half.z()}, {0, 0, 0}};
    return ggxD(Half<double>(pair), alpha);
}

double lambdaOf(const Direction& w, const Alpha<double>& alpha) {
    return ggxLambda(slope2(Vec<double>{w.x(), w.y(), w.z()}, alpha));
}

double answerOf(const std::string& spec, const LightView& pair) {
    return std::move(*makeModel(spec))->answer(pair).f.value[0];
}

TEST(GgxModel, PeakAtNormalIncidenceIsF0OverFourPiAlphaSquared) {
    for (double alpha : {1e-7, 1e-3, 0.1, 1.0}) {
        const double f =
            answerOf("ggx,f0=0.5,alpha=" + shortest(alpha), {Direction(), Direction()});
        expectRelative(f, 0.5 / (4 * kPi * alpha * alpha), 1e-14);
    }
}

TEST(GgxModel, SmallLambdaKeepsItsDigits) {
    const Direction w = Direction::fromSpherical(Radians(1e-6), Radians(0));
    const double x = 1e-6 * 1e-6 * 1e-12;  // (alpha tan)^2, alpha 1e-6
    expectRelative(lambdaOf(w, isotropic(1e-6)), x / 4, 1e-10);
}

TEST(GgxModel, DistributionProjectsOntoTheWholeSurface) {
    // Integral of D cos(theta) over the hemisphere is 1. With t = tan^2(theta) / alpha^2 the
    // isotropic integrand is dt / (1 + t)^2, so u = t / (1 + t) makes it constant: midpoints of u
    // and of phi are exact up to rounding; the anisotropic one is smooth in phi.
    for (const Alpha<double> alpha : {isotropic(0.01), isotropic(0.5), Alpha<double>{0.2, 0.6}}) {
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
                sum += dOf({s * std::cos(phi), s * std::sin(phi), c}, alpha) * weight * 2 * kPi /
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
        expectRelative(dOf(length * half, {0.1, 0.3}), dOf(half, {0.1, 0.3}), kRelative);
}

TEST(GgxModel, LambdaIsZeroAtTheNormalAndGrowsTowardGrazing) {
    for (double alpha : {1e-7, 0.1, 1.0}) {
        EXPECT_EQ(lambdaOf(Direction(), isotropic(alpha)), 0);
        double before = 0;
        for (double theta = 5; theta < 90; theta += 5) {
            const Direction w = Direction::fromSpherical(Radians::fromDegrees(theta), 0_deg);
            EXPECT_GT(lambdaOf(w, isotropic(alpha)), before);
            before = lambdaOf(w, isotropic(alpha));
        }
    }
}

TEST(GgxModel, SeparableMaskingIsNeverTheBrighter) {
    for (double in : {0.0, 40.0, 80.0, 89.9}) {
        for (double out : {0.0, 40.0, 80.0, 89.9}) {
            const auto pair =
                pairOf<double>({Direction::fromSpherical(Radians::fromDegrees(in), 0_deg),
                                Direction::fromSpherical(Radians::fromDegrees(out), 90_deg)});
            const double together = ggxV(pair, isotropic(0.5), Masking::HeightCorrelated);
            EXPECT_LE(ggxV(pair, isotropic(0.5), Masking::Separable), together * (1 + kRelative));
            EXPECT_TRUE(std::isfinite(together));
        }
    }
}

TEST(GgxModel, SchlickGoesFromF0AtTheNormalToOneAtGrazing) {
    for (double f0 : {0.0, 0.04, 1.0}) {
        EXPECT_EQ(schlick(f0, 1.0, 1.0), f0);
        EXPECT_EQ(schlick(f0, 1.0, 0.0), 1);
    }
    EXPECT_DOUBLE_EQ(schlick(0.04, 1.0, 0.5), 0.04 + 0.96 / 32);
}

TEST(GgxModel, ARoughWhiteMetalKeepsOneMinusLnTwo) {
    // Midpoint rule over s = sin^2(theta) at normal incidence, where f is isotropic in phi.
    const auto metal = std::move(*makeModel("ggx,alpha=1,f0=1"));
    constexpr int kRings = 20000;
    double energy = 0;
    for (int i = 0; i < kRings; ++i) {
        const Radians theta(std::asin(std::sqrt((i + 0.5) / kRings)));
        energy += metal->answer({Direction(), Direction::fromSpherical(theta, 0_deg)}).f.value[0] *
                  kPi / kRings;
    }
    EXPECT_NEAR(energy, 1 - std::log(2.0), 1e-5);
}

}  // namespace
}  // namespace gonio::proc
