#include "proc/models/gtr.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/models/spec.h"
#include "proc/solve/quadrature.h"

namespace gonio::proc {
namespace {

double f(const std::string& spec, const LightView& pair) {
    return std::move(*makeModel(spec))->answer(pair).f[Band::R];
}

const LightView kOffMirror{.in = Direction::fromSpherical(35_deg, 0_deg),
                           .out = Direction::fromSpherical(50_deg, 160_deg)};

TEST(GtrModel, IsGgxAtGammaTwo) {
    for (const std::string alpha : {"0.01", "0.2", "1"}) {
        const double gtr = f("gtr,gamma=2,f0=0.5,alpha=" + alpha, kOffMirror);
        EXPECT_NEAR(gtr, f("ggx,f0=0.5,alpha=" + alpha, kOffMirror), 1e-12 * gtr);
    }
}

TEST(GtrModel, HasItsLimitAtGammaOneAndAtAlphaOne) {
    EXPECT_NEAR(gtrPeak(0.3, 1.0), gtrPeak(0.3, 1 + 1e-7), 1e-6 * gtrPeak(0.3, 1.0));
    EXPECT_NEAR(gtrPeak(1.0, 3.0), 1 / kPi, 1e-15);
    EXPECT_NEAR(gtrPeak(1 - 1e-9, 3.0), 1 / kPi, 1e-7);
    // Both sides of where the series takes over.
    const double at = std::exp(-0.5e-4);
    EXPECT_NEAR(gtrPeak(at * (1 - 1e-9), 7.0), gtrPeak(at * (1 + 1e-9), 7.0), 1e-8);
}

/// The integral of D cos(theta_h), u = sin^2: pi times that of D du.
TEST(GtrModel, HasNormalsThatCoverTheSurfaceOnce) {
    for (const double alpha : {0.05, 0.3, 0.9}) {
        for (const double gamma : {0.5, 1.0, 1.5, 2.0, 5.0, 10.0}) {
            const double a2 = alpha * alpha;
            double sum = 0;
            for (const QuadratureNode& node : tanhSinh(200)) {
                const double s = node.x * node.x;  // denser at the normal
                sum += node.weight * 2 * node.x * std::pow(a2 / (s + a2 * (1 - s)), gamma);
            }
            EXPECT_NEAR(kPi * sum * gtrPeak(alpha, gamma), 1, 1e-9) << alpha << " " << gamma;
        }
    }
}

TEST(GtrModel, RefusesGammaOutOfItsDomain) {
    EXPECT_FALSE(makeModel("gtr,alpha=0.2,gamma=0.4,f0=0.5"));
    EXPECT_FALSE(makeModel("gtr,alpha=0.2,gamma=11,f0=0.5"));
    EXPECT_FALSE(makeModel("gtr,alpha=0.2,f0=0.5"));
}

}  // namespace
}  // namespace gonio::proc
