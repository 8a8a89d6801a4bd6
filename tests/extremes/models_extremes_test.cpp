// No NaN, no infinity, no negative value anywhere in the domains, in double and float, at every
// effort: one by one with floating-point traps on; in arrays by their values, as a loop over
// vectors works out both sides of a choice and the lanes past its end.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/models/spec.h"
#include "tests/support/floating_point_traps.h"
#include "tests/support/model_specs.h"
#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

/// Poles, grazing to 1e-9 and below, denormal components, and directions hard by each other.
std::vector<Direction> edges() {
    std::vector<Direction> all;
    for (double theta : {0.0, 1e-160, 1e-30, 1e-12, 1e-7, 1e-3, 0.7, 1.57}) {
        for (double phi : {0.0, 1e-9, 2.0, kPi}) {
            all.push_back(Direction::fromSpherical(Radians(theta), Radians(phi)));
        }
    }
    // Rounding takes the cosine of opposite directions at the horizon below -1 at some azimuths.
    for (int i = 0; i < 12; ++i) {
        const double phi = 0.37 * i;
        for (double sign : {1.0, -1.0}) {
            all.push_back(
                *Direction::fromVector({sign * std::cos(phi), sign * std::sin(phi), 1e-9}));
        }
    }
    for (double mu : {1e-3, 1e-6, 1e-9, 1e-12, 1e-38, 1e-45, 1e-300, 5e-324}) {
        for (double sign : {1.0, -1.0}) {
            all.push_back(*Direction::fromVector({sign, 0, mu}));
            all.push_back(*Direction::fromVector({0.6 * sign, 0.8, mu}));
        }
    }
    return all;
}

class ModelExtremes : public ::testing::TestWithParam<std::string> {};

TEST_P(ModelExtremes, AreFiniteAndNotNegative) {
    const std::vector<Direction> directions = edges();
    for (Effort effort : {Effort::Draft, Effort::Standard, Effort::Reference}) {
        for (Precision precision : {Precision::Float, Precision::Double}) {
            const auto made = makeModel(GetParam(), {effort, precision});
            ASSERT_TRUE(made) << made.error().message;
            const test::FloatingPointTraps on;
            for (const Direction& wi : directions) {
                for (const Direction& wo : directions) {
                    const LedBands f = (*made)->answer({wi, wo}).f;
                    for (Band b : kBands) {
                        ASSERT_TRUE(std::isfinite(f[b]) && f[b] >= 0)
                            << f[b] << " at " << wi.vector().transpose() << ", "
                            << wo.vector().transpose() << ", effort " << name(effort);
                    }
                }
            }
        }
    }
}

template <class T>
void expectFiniteArrays(const AnalyticModel& model, const std::vector<LightView>& pairs) {
    std::array<std::vector<T>, 6> in;
    std::array<std::vector<T>, 3> out;
    for (auto& one : out) one.resize(pairs.size());
    for (const LightView& pair : pairs) {
        for (Eigen::Index k = 0; k < 3; ++k) {
            in.at(static_cast<std::size_t>(k)).push_back(static_cast<T>(pair.in.vector()[k]));
            in.at(static_cast<std::size_t>(k + 3)).push_back(static_cast<T>(pair.out.vector()[k]));
        }
    }
    model.evaluate(PairArrays<T>{in[0], in[1], in[2], in[3], in[4], in[5]},
                   BandArrays<T>{out[0], out[1], out[2]});
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const bool above = in[2][i] > 0 && in[5][i] > 0;
        for (const auto& band : out) {
            ASSERT_EQ(std::isfinite(band[i]), above) << band[i] << " at " << i;
            if (above) {
                ASSERT_GE(band[i], 0);
            }
        }
    }
}

TEST_P(ModelExtremes, InArraysToo) {
    std::vector<LightView> pairs;
    for (const Direction& wi : edges()) {
        for (const Direction& wo : edges()) pairs.push_back({wi, wo});
    }
    const auto made = makeModel(GetParam(), {Effort::Standard, Precision::Double});
    ASSERT_TRUE(made);
    expectFiniteArrays<double>(**made, pairs);
    expectFiniteArrays<float>(**made, pairs);
}

TEST_P(ModelExtremes, OppositeAndEqualDirectionsAreDefined) {
    std::mt19937_64 random(8);
    const auto made = makeModel(GetParam());
    ASSERT_TRUE(made);
    const test::FloatingPointTraps on;
    for (int i = 0; i < 500; ++i) {
        const Direction w = test::randomDirection(random);
        const Direction opposite = *Direction::fromVector(-w.vector());
        EXPECT_TRUE(std::isfinite((*made)->answer({w, w}).f[Band::G]));
        EXPECT_TRUE(std::isfinite((*made)->answer({w, mirrorOf(w)}).f[Band::G]));
        EXPECT_FALSE((*made)->answer({w, opposite}).present());
        // Almost opposite, and both above: grazing.
        const Direction low = Direction::fromSpherical(Radians(kPi / 2 - 1e-9), w.phi());
        EXPECT_TRUE(std::isfinite((*made)->answer({low, mirrorOf(low)}).f[Band::G]));
    }
}

INSTANTIATE_TEST_SUITE_P(All,
                         ModelExtremes,
                         ::testing::ValuesIn(test::extremeSpecs()),
                         [](const auto& one) {
                             std::string name;
                             for (char c : one.param) {
                                 name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                             }
                             return name;
                         });

TEST(ModelExtremes, HaveFiniteDensitiesOfDraws) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const std::string& spec : test::extremeSpecs()) {
        const auto made = makeModel(spec);
        ASSERT_TRUE(made);
        const LobeMixture lobes = (*made)->lobes();
        const test::FloatingPointTraps on;
        for (const Direction& wi : edges()) {
            if (!wi.aboveHorizon()) continue;
            for (const double end : {0.0, 0.5, 1 - 1e-16}) {
                const auto wo = drawDirection(lobes, wi, {unit(random), end, unit(random)});
                if (!wo) continue;
                const double density = drawDensity(lobes, {wi, *wo});
                EXPECT_TRUE(std::isfinite(density) && density >= 0) << spec;
            }
        }
    }
}

}  // namespace
}  // namespace gonio::proc
