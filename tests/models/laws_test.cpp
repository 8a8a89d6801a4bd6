// Laws that every model must obey: reciprocity, energy, no NaN, no negative value at the extremes.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/models/spec.h"
#include "tests/support/reference_csv.h"

namespace gonio::proc {
namespace {

const std::vector<std::string> kSpecs{"lambert,albedo=0.3/0.1/0.05",
                                      "oren-nayar,albedo=0.8,sigma=0.3",
                                      "ggx,alpha=0.05,f0=0.9/0.7/0.4",
                                      "ggx,alpha=1e-7,f0=1",
                                      "ggx,alpha_x=0.1,alpha_y=0.4,f0=0.04,masking=separable",
                                      "lambert,albedo=0.3+ggx,roughness=0.5,f0=0.04"};

std::unique_ptr<const Scatterer> model(const std::string& spec) {
    auto made = makeModel(spec);
    EXPECT_TRUE(made) << spec;
    return std::move(*made);
}

Direction randomDirection(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    return Direction::fromSpherical(Radians(std::acos(1 - unit(random))),
                                    Radians(2 * kPi * unit(random)));
}

TEST(Models, AreReciprocal) {
    std::mt19937_64 random(2);
    for (const std::string& spec : kSpecs) {
        const auto m = model(spec);
        for (int i = 0; i < 2000; ++i) {
            const Direction a = randomDirection(random);
            const Direction b = randomDirection(random);
            const LedBands ab = m->answer({a, b}).f;
            const LedBands ba = m->answer({b, a}).f;
            for (Band band : kBands) EXPECT_NEAR(ab[band], ba[band], 1e-13 * ab[band]) << spec;
        }
    }
}

TEST(Models, ReflectNoMoreThanTheyReceive) {
    for (const std::string& spec : kSpecs) {
        if (spec.find("1e-7") != std::string::npos) continue;  // a lobe finer than the quadrature
        const auto m = model(spec);
        for (double degrees : {0.0, 20.0, 40.0, 60.0, 75.0}) {
            const Direction wi =
                Direction::fromSpherical(Radians::fromDegrees(degrees), Radians(0));
            constexpr int kTheta = 600;
            constexpr int kPhi = 600;
            double albedo = 0;
            for (int i = 0; i < kTheta; ++i) {
                const Radians theta((i + 0.5) * kPi / 2 / kTheta);
                double ring = 0;
                for (int j = 0; j < kPhi; ++j) {
                    const Radians phi((j + 0.5) * 2 * kPi / kPhi);
                    ring += m->answer({wi, Direction::fromSpherical(theta, phi)}).f[Band::R];
                }
                albedo += ring * cos(theta) * sin(theta) * (kPi / 2 / kTheta) * (2 * kPi / kPhi);
            }
            EXPECT_LE(albedo, 1.001) << spec << " at " << degrees;
        }
    }
}

TEST(Models, AreFiniteAndNotNegativeAtTheExtremes) {
    std::vector<Direction> edges;
    for (double theta : {0.0, 1e-12, 1e-6, 1.0, kPi / 2 - 1e-6, kPi / 2 - 1e-9}) {
        for (double phi : {0.0, 1.0, kPi}) {
            edges.push_back(Direction::fromSpherical(Radians(theta), Radians(phi)));
        }
    }
    for (const std::string& spec : kSpecs) {
        const auto m = model(spec);
        for (const Direction& wi : edges) {
            for (const Direction& wo : edges) {
                const LedBands f = m->answer({wi, wo}).f;
                for (Band b : kBands) {
                    EXPECT_TRUE(std::isfinite(f[b]) && f[b] >= 0) << spec << " " << f[b];
                }
            }
        }
    }
}

TEST(Models, AnswerNothingBelowTheHorizon) {
    const Direction below = *Direction::fromVector({0.1, 0, -1});
    const Direction grazing = *Direction::fromVector({1, 0, 0});
    for (const std::string& spec : kSpecs) {
        const auto m = model(spec);
        for (const LightView& pair : {LightView{Direction(), below},
                                      LightView{below, Direction()},
                                      LightView{Direction(), grazing}}) {
            const Answer answer = m->answer(pair);
            EXPECT_FALSE(answer.present());
            EXPECT_TRUE(answer.flags.has(Flag::BelowHorizon));
        }
    }
}

TEST(OrenNayarModel, MatchesSixtyDigits) {
    for (const auto& row : test::referenceRows("diffuse_models")) {
        const auto wi = Direction::fromVector({row[0], row[1], row[2]});
        const auto wo = Direction::fromVector({row[3], row[4], row[5]});
        const auto m = model("oren-nayar,albedo=1,sigma=0");
        ASSERT_TRUE(wi && wo);
        const auto exact = model("oren-nayar,albedo=1,sigma=" + shortest(row[6]));
        EXPECT_NEAR(exact->answer({*wi, *wo}).f[Band::G], row[7], 1e-13 * row[7] + 1e-300);
        EXPECT_DOUBLE_EQ(m->answer({*wi, *wo}).f[Band::G], 1 / kPi);
    }
}

}  // namespace
}  // namespace gonio::proc
