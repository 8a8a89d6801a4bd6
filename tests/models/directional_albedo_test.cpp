#include "proc/models/directional_albedo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "proc/models/multiple_scattering.h"
#include "proc/models/spec.h"
#include "proc/solve/quadrature.h"
#include "tests/support/reference_csv.h"

namespace gonio::proc {
namespace {

struct Within {
    double e, oneMinusE, a, b;
};

/// Rows are alpha, mu, E, 1 - E, A, B.
void expectWithin(const std::function<DirectionalAlbedo(const AlbedoPoint&)>& albedo,
                  const Within& within) {
    for (const auto& row : test::referenceTable("ggx_directional_albedo_dfg").rows) {
        const DirectionalAlbedo seen = albedo({.alpha = row[0], .mu = row[1]});
        EXPECT_NEAR(seen.e, row[2], within.e) << row[0] << " " << row[1];
        EXPECT_NEAR(seen.oneMinusE, row[3], within.oneMinusE) << row[0] << " " << row[1];
        EXPECT_NEAR(seen.a, row[4], within.a) << row[0] << " " << row[1];
        EXPECT_NEAR(seen.b, row[5], within.b) << row[0] << " " << row[1];
    }
}

TEST(DirectionalAlbedo, OfTheReferenceIsWithin1e11) {
    expectWithin([](const AlbedoPoint& at) { return ggxAlbedo(at, Effort::Reference); },
                 {1e-11, 1e-11, 1e-11, 1e-11});
}

TEST(DirectionalAlbedo, Of256EvaluationsIsWithin15Millionths) {
    expectWithin([](const AlbedoPoint& at) { return ggxAlbedo(at, Effort::Standard); },
                 {1.5e-5, 1.5e-5, 1.5e-5, 1.5e-5});
}

TEST(DirectionalAlbedo, OfADraftIsWithinThreeThousandths) {
    expectWithin([](const AlbedoPoint& at) { return ggxAlbedo(at, Effort::Draft); },
                 {3e-3, 3e-3, 3e-3, 3e-3});
}

TEST(AlbedoCurve, IsWithinAMillionthOfTheReference) {
    std::map<double, AlbedoCurve> curves;
    expectWithin(
        [&](const AlbedoPoint& at) {
            return curves.try_emplace(at.alpha, at.alpha).first->second.at(at.mu);
        },
        {1e-6, 1e-6, 1e-6, 1e-6});
}

TEST(DirectionalAlbedo, LosesNoDigitOfWhatIsLost) {
    // 1 - E is 1e-6 at the smallest, where a difference of doubles would keep ten digits.
    for (const auto& row : test::referenceTable("ggx_directional_albedo_dfg").rows) {
        const auto seen = ggxAlbedo({.alpha = row[0], .mu = row[1]}, Effort::Reference);
        EXPECT_NEAR(seen.oneMinusE / row[3], 1, 1e-8) << row[0] << " " << row[1];
    }
}

TEST(DirectionalAlbedo, AveragesMatchTheTable) {
    for (const auto& row : test::referenceTable("ggx_average_albedo").rows) {
        const AverageAlbedo reference = ggxAverageAlbedo(row[0], Effort::Reference);
        EXPECT_NEAR(reference.e, row[1], 1e-11) << row[0];
        EXPECT_NEAR(reference.oneMinusE / row[2], 1, 1e-8) << row[0];
        EXPECT_NEAR(AlbedoCurve(row[0]).average().e, row[1], 1e-6) << row[0];
    }
}

TEST(DirectionalAlbedo, AtAlphaOneAndTheNormalIsOneMinusLnTwo) {
    EXPECT_NEAR(ggxAlbedo({.alpha = 1, .mu = 1}, Effort::Reference).e, 1 - std::log(2.0), 1e-12);
}

/// The model itself, integrated: over tan(theta_h) about the lobe would repeat the rule above, so
/// this one is over wo, in sin^2(theta) and phi, for lobes that such a grid resolves.
double integrated(const std::string& spec, double mu) {
    const auto model = std::move(*makeModel(spec));
    const Direction wi = Direction::fromSpherical(Radians(std::acos(mu)), Radians(0));
    double sum = 0;
    const auto nodes = gaussLegendre(200);
    for (const QuadratureNode& ring : nodes) {
        const Radians theta(kPi / 2 * ring.x);
        for (const QuadratureNode& sector : nodes) {
            const Direction wo = Direction::fromSpherical(theta, Radians(kPi * sector.x));
            // Twice the half in phi; sin(theta) cos(theta) dtheta dphi.
            sum += model->answer({wi, wo}).f[Band::G] * sin(theta) * cos(theta) * kPi / 2 * 2 *
                   kPi * ring.weight * sector.weight;
        }
    }
    return sum;
}

TEST(MultipleScattering, OfKullaAndContyGivesAWhiteFurnaceBack) {
    for (const std::string alpha : {"0.2", "0.5", "1"}) {
        const std::string spec = "ggx,f0=1,multiscatter=kulla-conty,alpha=" + alpha;
        for (double mu : {0.2, 0.6, 1.0}) {
            EXPECT_NEAR(integrated(spec, mu), 1, 1e-4) << spec << " " << mu;
        }
    }
}

TEST(MultipleScattering, OfFdezAgueraSeesAWhiteFurnaceAsWhite) {
    // E + FmsEms = 1 at F = 1.
    for (double alpha : {0.01, 0.3, 1.0}) {
        const AlbedoCurve curve(alpha);
        for (double mu : {1e-3, 0.1, 0.7, 1.0}) {
            const DirectionalAlbedo at = curve.at(mu);
            EXPECT_NEAR(at.e + fdezAguera(1.0, at), 1, 1e-12) << alpha << " " << mu;
        }
    }
}

TEST(MultipleScattering, OfKullaAndContyGivesBackWhatIsLostAtEveryAlpha) {
    // The bounce is integrated as it is; the lobe, which is too sharp for that, is the reference's
    // E.
    for (double alpha : {1e-3, 0.01, 0.1, 0.5, 1.0}) {
        const AlbedoCurve curve(alpha);
        for (double muIn : {1e-4, 1e-2, 0.3, 1.0}) {
            double bounced = 0;
            for (const QuadratureNode& node : gaussLegendre(64)) {
                const double mu = node.x * node.x;  // 2 pi f mu dmu, drawn to grazing
                bounced += node.weight * 2 * node.x * 2 * mu * curve.oneMinusE(muIn) *
                           curve.oneMinusE(mu) / curve.average().oneMinusE *
                           bouncedFresnel(1.0, curve.average());
            }
            const double single = ggxAlbedo({.alpha = alpha, .mu = muIn}, Effort::Reference).e;
            EXPECT_NEAR(single + bounced, 1, 1e-4) << alpha << " " << muIn;
        }
    }
}

}  // namespace
}  // namespace gonio::proc
