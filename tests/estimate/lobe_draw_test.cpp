#include "proc/estimate/lobe_draw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/estimate/albedo.h"
#include "proc/estimate/bake.h"
#include "proc/solve/quadrature.h"
#include "tests/estimate/scatterers.h"

namespace gonio::proc {
namespace {

using test::model;
using test::tilted;

constexpr int kRings = 24, kSectors = 36, kDraws = 200000;

BakedTable table(double alpha) {
    const std::string a = std::to_string(alpha), twice = std::to_string(2 * alpha);
    const auto truth =
        model("lambert,albedo=0.3+ggx,f0=0.04,alpha=" + a + "+ggx,f0=0.03,alpha=" + twice);
    return std::move(*bakeTable(*truth, model("lambert,albedo=0.3+ggx,f0=0.05,alpha=" + a)));
}

/// Of a cell of sin^2(theta) x phi, by quadrature of the density.
double expectedShare(const LobeDraw& draw, const Direction& wi, int i, int j) {
    static const auto nodes = gaussLegendre(8);
    double sum = 0;
    for (const QuadratureNode& a : nodes) {
        const double s2 = (i + a.x) / kRings;
        const Radians theta(std::atan2(std::sqrt(s2), std::sqrt(1 - s2)));
        for (const QuadratureNode& b : nodes) {
            const Radians phi(2 * kPi * (j + b.x) / kSectors);
            const Direction wo = Direction::fromSpherical(theta, phi);
            sum += a.weight * b.weight * draw.density({wi, wo}) / (2 * cos(theta));
        }
    }
    return sum * 2 * kPi / (kRings * kSectors);
}

struct Counted {
    std::vector<double> cells = std::vector<double>(kRings * kSectors, 0.0);
    double empty = 0;
};

Counted counted(const LobeDraw& draw, const Direction& wi) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit;
    Counted counts;
    for (int k = 0; k < kDraws; ++k) {
        const double lobe = unit(random);
        const double u = unit(random);
        const auto drawn = draw.draw(wi, {lobe, u, unit(random)});
        if (!drawn) {
            ++counts.empty;
            continue;
        }
        const double z = drawn->wo.z();
        const int i = std::min(kRings - 1, static_cast<int>((1 - z) * (1 + z) * kRings));
        const int j = std::min(kSectors - 1,
                               static_cast<int>(drawn->wo.phi().value() / (2 * kPi) * kSectors));
        ++counts.cells[static_cast<std::size_t>(i * kSectors + j)];
    }
    return counts;
}

TEST(LobeDraw, DrawsAsItsDensitySays) {
    const LobeDraw draw(table(0.16), lobesAbout(0.1));
    for (const double degrees : {0.0, 40.0, 70.0}) {
        const Direction wi = tilted(degrees);
        const Counted counts = counted(draw, wi);
        double chiSquare = 0, total = 0;
        int cells = 0;
        for (int i = 0; i < kRings; ++i) {
            for (int j = 0; j < kSectors; ++j) {
                const double share = expectedShare(draw, wi, i, j);
                total += share;
                const double expected = share * kDraws;
                if (expected < 20) continue;
                const double count = counts.cells[static_cast<std::size_t>(i * kSectors + j)];
                chiSquare += (count - expected) * (count - expected) / expected;
                ++cells;
            }
        }
        EXPECT_NEAR(total + counts.empty / kDraws, 1, 0.006) << degrees;
        EXPECT_GT(cells, 200);
        // Five standard deviations of chi-square, and 1e-4 of the counts for the quadrature.
        EXPECT_LT(chiSquare, cells + 5 * std::sqrt(2.0 * cells) + 1e-4 * kDraws) << degrees;
    }
}

TEST(LobeDraw, GivesBackTheAlbedo) {
    for (const double alpha : {0.02, 0.16}) {
        const BakedTable of = table(alpha);
        const LobeDraw draw(of, lobesAbout(0.65 * alpha));
        const Direction wi = tilted(50);
        std::mt19937_64 random(12);
        std::uniform_real_distribution<double> unit;
        double sum = 0, squares = 0;
        constexpr int kFew = 40000;
        for (int k = 0; k < kFew; ++k) {
            const double lobe = unit(random);
            const double u = unit(random);
            const auto drawn = draw.draw(wi, {lobe, u, unit(random)});
            if (!drawn) continue;
            const double value =
                of.evaluate({wi, drawn->wo})[Band::G] * drawn->wo.z() / drawn->density;
            sum += value;
            squares += value * value;
        }
        const double mean = sum / kFew;
        const double error = std::sqrt((squares / kFew - mean * mean) / kFew);
        EXPECT_NEAR(mean, directionalAlbedo(of, wi)[Band::G].value, 5 * error) << alpha;
        // The spread of the draws is the one that the quadrature tells: the fourth moment of this
        // many draws leaves a few per cent.
        EXPECT_NEAR(
            error * error * kFew / (mean * mean), relativeVariance(of, wi, draw.mixtureAt(wi)), 0.1)
            << alpha;
    }
}

TEST(LobeDraw, VariesFarLessThanCosineSampling) {
    for (const double alpha : {0.02, 0.16}) {
        const BakedTable of = table(alpha);
        const LobeDraw draw(of, lobesAbout(0.65 * alpha));
        for (const double degrees : {0.0, 45.0, 75.0}) {
            const Direction wi = tilted(degrees);
            const double ours = relativeVariance(of, wi, draw.mixtureAt(wi));
            const double cosine = relativeVariance(of, wi, {{}});
            EXPECT_LT(ours, 0.25) << alpha << " " << degrees;
            EXPECT_LT(ours, cosine) << alpha << " " << degrees;
        }
    }
}

TEST(LobeDraw, DrawsEvenlyFromItsLobesWhereThereIsNoLight) {
    const test::Made dark([](const LightView&) { return test::answerOf(0); });
    const LobeDraw draw(dark, lobesAbout(0.1));
    const LobeMixture& mixture = draw.mixtureAt(tilted(30));
    for (const WeightedLobe& one : mixture) EXPECT_EQ(one.weight, mixture.front().weight);
    EXPECT_TRUE(std::isnan(relativeVariance(dark, tilted(30), mixture)));
}

TEST(LobeDraw, GrazingIncidenceIsServedByTheLastWeights) {
    const LobeDraw draw(table(0.16), lobesAbout(0.1));
    for (const double degrees : {89.0, 89.999}) {
        const auto drawn = draw.draw(tilted(degrees), {0.0, 0.3, 0.4});
        ASSERT_TRUE(drawn.has_value());
        EXPECT_GT(drawn->density, 0);
        EXPECT_EQ(drawn->density, draw.density({tilted(degrees), drawn->wo}));
    }
}

}  // namespace
}  // namespace gonio::proc
