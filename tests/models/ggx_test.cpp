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

}  // namespace
}  // namespace gonio::proc
