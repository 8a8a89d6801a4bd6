#include "proc/estimate/baked_table.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "proc/estimate/bake.h"
#include "proc/estimate/lookup_pairs.h"
#include "tests/estimate/allocation_count.h"
#include "tests/estimate/scatterers.h"

namespace gonio::proc {
namespace {

using test::answerOf;
using test::Made;
using test::model;
using test::tilted;

struct Material {
    std::string truth, carrier;
};

/// Two lobes, which no Lambert and one GGX lobe can follow, and a carrier beside both.
Material twoLobes(double alpha, const std::string& second = "ggx") {
    const auto text = [](double value) { return std::to_string(value); };
    return {"lambert,albedo=0.3/0.2/0.1+ggx,f0=0.04,alpha=" + text(alpha) + "+" + second +
                ",f0=0.03,alpha=" + text(2 * alpha),
            "lambert,albedo=0.3/0.2/0.1+ggx,f0=0.055,alpha=" + text(1.3 * alpha)};
}

BakedTable baked(const Material& material, const BakeOptions& options = {}) {
    return std::move(*bakeTable(*model(material.truth),
                                material.carrier.empty() ? nullptr : model(material.carrier),
                                options));
}

double worstError(const BakedTable& table,
                  const Scatterer& truth,
                  const std::vector<LightView>& at) {
    double worst = 0;
    for (const LightView& pair : at) {
        const LedBands f = table.evaluate(pair);
        const LedBands exact = truth.answer(pair).f;
        for (const Band band : kBands) {
            worst = std::max(worst, std::abs(f[band] / exact[band] - 1));
        }
    }
    return worst;
}

TEST(BakedTable, IsWithinOnePerCentOfTwoLobesOfWidth016AndFiveOf002) {
    for (const auto& [alpha, limit] : {std::pair{0.16, 0.01}, std::pair{0.02, 0.05}}) {
        for (const char* second : {"ggx", "beckmann"}) {
            const Material material = twoLobes(alpha, second);
            const auto truth = model(material.truth);
            const auto lobe = lobePairs({20000, 9}, alpha);
            for (const TableStorage storage : {TableStorage::Float, TableStorage::Half}) {
                const BakedTable table = baked(material, {.resolution = {}, .storage = storage});
                EXPECT_LT(worstError(table, *truth, cosinePairs({20000, 8})), limit)
                    << alpha << " " << second;
                EXPECT_LT(worstError(table, *truth, lobe), limit) << alpha << " " << second;
            }
        }
    }
}

TEST(BakedTable, ErrsWithTheSquareOfItsSpacing) {
    const Material material = twoLobes(0.16);
    const auto truth = model(material.truth);
    const auto pairs = cosinePairs({10000, 8});
    const auto errorAt = [&](const BoxResolution& resolution) {
        return worstError(
            baked(material, {.resolution = resolution, .storage = TableStorage::Float}),
            *truth,
            pairs);
    };
    // Twice as many nodes: a quarter of the error, a third where a corner is met unluckily.
    EXPECT_LT(errorAt({64, 32, 16}), errorAt({32, 16, 8}) / 3);
}

TEST(BakedTable, MatchesReference) {
    // Seeded pairs and the extremes of all three coordinates.
    std::vector<LightView> pairs = cosinePairs({5000, 21});
    for (const double in : {0.0, 1e-6, 45.0, 89.0, 89.99}) {
        for (const double out : {0.0, 30.0, 89.0, 89.99}) {
            for (const double azimuth : {0.4, 0.4 + kPi, 2.0}) {
                pairs.push_back({tilted(in), tilted(out, azimuth)});
            }
        }
    }
    for (const TableStorage storage : {TableStorage::Float, TableStorage::Half}) {
        for (const bool carried : {true, false}) {
            Material material = twoLobes(0.16);
            if (!carried) material.carrier.clear();
            const BakedTable table = baked(material, {.resolution = {}, .storage = storage});
            for (const LightView& pair : pairs) {
                const LedBands fast = table.evaluate(pair);
                const LedBands slow = evaluateReference(table, pair);
                for (const Band band : kBands) {
                    // A place is off by 1e-5 of a cell; a cell spans up to a factor of 2.
                    EXPECT_NEAR(fast[band] / slow[band], 1, 5e-5)
                        << pair.in.theta().degrees() << " " << pair.out.theta().degrees();
                }
            }
        }
    }
}

TEST(BakedTable, ArraysGiveWhatPairsGive) {
    const auto pairs = cosinePairs({1001, 5});  // three blocks and a part of one
    std::array<std::vector<float>, 9> a;
    for (const LightView& pair : pairs) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            a[k].push_back(static_cast<float>(pair.in.vector()[axis]));
            a[k + 3].push_back(static_cast<float>(pair.out.vector()[axis]));
        }
    }
    a[2][17] = -0.1F;  // below the horizon
    a[5][600] = std::numeric_limits<float>::quiet_NaN();
    a[0][601] = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t k = 6; k < 9; ++k) a[k].resize(pairs.size());
    for (const TableStorage storage : {TableStorage::Float, TableStorage::Half}) {
        for (const bool carried : {true, false}) {
            Material material = twoLobes(0.16);
            if (!carried) material.carrier.clear();
            const BakedTable table = baked(material, {.resolution = {}, .storage = storage});
            table.evaluate(PairArrays<float>{a[0], a[1], a[2], a[3], a[4], a[5]},
                           BandArrays<float>{a[6], a[7], a[8]});
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (i == 17 || i == 600 || i == 601) {
                    EXPECT_TRUE(std::isnan(a[7][i])) << i;
                    continue;
                }
                // Directions narrowed to float: 1e-7 of a component, on the side of a lobe.
                EXPECT_NEAR(
                    static_cast<double>(a[7][i]) / table.evaluate(pairs[i])[Band::G], 1, 2e-5);
            }
        }
    }
}

TEST(BakedTable, ALookUpAllocatesNothing) {
    const BakedTable table = baked(twoLobes(0.16));
    const auto pairs = cosinePairs({600, 5});
    std::array<std::vector<float>, 9> a;
    for (auto& values : a) values.assign(pairs.size(), 0.5F);
    const std::size_t before = test::allocationCount();
    LedBands sum;
    for (const LightView& pair : pairs) sum = sum + table.answer(pair).f;
    table.evaluate(PairArrays<float>{a[0], a[1], a[2], a[3], a[4], a[5]},
                   BandArrays<float>{a[6], a[7], a[8]});
    EXPECT_EQ(test::allocationCount(), before);
    EXPECT_GT(sum[Band::G], 0);
}

TEST(BakedTable, TwiceItsUncertaintyHoldsNineteenOfTwentyErrors) {
    for (const double alpha : {0.02, 0.16}) {
        const Material material = twoLobes(alpha);
        const auto truth = model(material.truth);
        const BakedTable table = baked(material);
        int held = 0;
        const auto pairs = lobePairs({20000, 9}, alpha);
        for (const LightView& pair : pairs) {
            const Answer answer = table.answer(pair);
            const double error = std::abs(answer.f[Band::G] - truth->answer(pair).f[Band::G]);
            if (error <= 2 * *answer.u(Band::G)) ++held;
            EXPECT_EQ(answer.source, Source::Interpolated);
        }
        EXPECT_GE(held, 0.95 * static_cast<double>(pairs.size())) << alpha;
    }
}

TEST(BakedTable, KnowsTheErrorOfOneBandWhereAnotherIsDark) {
    const auto lobe = model("lambert,albedo=0.1+ggx,alpha=0.2,f0=0.5");
    const Made green([&](const LightView& pair) {
        Answer answer = lobe->answer(pair);
        answer.f[Band::R] = 0;
        return answer;
    });
    const BoxResolution coarse{8, 4, 3};
    const BakedTable dark = std::move(*bakeTable(green, nullptr, {.resolution = coarse}));
    const BakedTable bright = std::move(*bakeTable(*lobe, nullptr, {.resolution = coarse}));
    EXPECT_GT(dark.report().worstError, 0.01);
    EXPECT_EQ(dark.report().worstError, bright.report().worstError);
    for (const LightView& pair : cosinePairs({50, 3})) {
        EXPECT_DOUBLE_EQ(*dark.answer(pair).u(Band::G), *bright.answer(pair).u(Band::G));
    }
}

TEST(BakedTable, TakesAnErrorThatItCannotKnowAsItsWorst) {
    // Dark from 40 degrees between the normal and the half vector on: nothing to be relative to.
    const auto lobe = model("lambert,albedo=0.1+ggx,alpha=0.2,f0=0.5");
    const Made spot([&](const LightView& pair) {
        const Direction half = *Direction::fromVector(pair.in.vector() + pair.out.vector());
        return half.theta() < 40_deg ? lobe->answer(pair) : answerOf(0);
    });
    const BakedTable table = std::move(*bakeTable(spot, nullptr, {.resolution = {24, 4, 3}}));
    const Answer answer = table.answer({tilted(70), tilted(72, 0.4)});
    EXPECT_NEAR(*answer.u(Band::G) / answer.f[Band::G], table.report().worstError, 1e-3);
    EXPECT_GT(table.report().worstError, 0.01);
}

TEST(BakedTable, HoldsErrorsThatAHalfCannot) {
    // Some e^10 from one direction to the next.
    const Made wild([](const LightView& pair) {
        return answerOf(std::exp(10 * std::sin(1e5 * (pair.in.z() + pair.out.z()))));
    });
    const BakedTable table = std::move(
        *bakeTable(wild, nullptr, {.resolution = {16, 8, 4}, .storage = TableStorage::Half}));
    EXPECT_GT(table.report().worstError, 100);
    for (const LightView& pair : cosinePairs({500, 3})) {
        EXPECT_TRUE(std::isfinite(*table.answer(pair).u(Band::G)));
    }
}

TEST(BakedTable, IsExactWhereTheTruthIsItsCarrier) {
    const std::string spec = "lambert,albedo=0.3+ggx,f0=0.04,alpha=0.1";
    const BakedTable table = baked({spec, spec}, {.resolution = {4, 3, 2}});
    EXPECT_LT(worstError(table, *model(spec), cosinePairs({5000, 2})), 1e-6);
    EXPECT_LT(table.report().worstError, 1e-6);
}

TEST(BakedTable, SaysWhenASurfaceIsNotWhatItCanHold) {
    EXPECT_LT(baked(twoLobes(0.16)).report().asymmetry, 1e-9);
    const BakedTable grain = baked({"ggx,alpha_x=0.1,alpha_y=0.4,f0=0.5", "lambert,albedo=1"});
    EXPECT_GT(grain.report().asymmetry, 0.5);
}

TEST(BakedTable, KeepsNegativeValuesWithACarrierAndCountsThemWithout) {
    const Made noise([](const LightView&) { return answerOf(-0.01); });
    const BakedTable carried = std::move(*bakeTable(noise, model("lambert,albedo=0.5")));
    EXPECT_NEAR(carried.evaluate({tilted(20), tilted(40)})[Band::G], -0.01, 1e-5);
    const BakedTable alone = std::move(*bakeTable(noise, nullptr));
    EXPECT_EQ(alone.report().notHeld, alone.axes().resolution().nodes());
    EXPECT_LT(alone.evaluate({tilted(20), tilted(40)})[Band::G], 1e-8);
}

TEST(BakedTable, HasNoAnswerWhereTheBakedScattererHadNone) {
    const Made half([](const LightView& pair) {
        const bool seen = pair.in.theta() < 70_deg && pair.out.theta() < 70_deg;
        return answerOf(seen ? 0.1 : std::numeric_limits<double>::quiet_NaN());
    });
    const BakedTable table = std::move(*bakeTable(half, model("lambert,albedo=0.5")));
    EXPECT_GT(table.report().unanswered, 0U);
    EXPECT_FALSE(table.answer({tilted(80), tilted(80)}).present());
    EXPECT_FALSE(table.answer({tilted(80), tilted(80)}).u(Band::G).has_value());
    EXPECT_NEAR(table.answer({tilted(20), tilted(30)}).f[Band::G], 0.1, 1e-4);
}

TEST(BakedTable, AnswersAtTheEdgesOfItsDomain) {
    const BakedTable table = baked(twoLobes(0.02));
    const Direction up;
    const Direction flat = *Direction::fromVector({1, 0, 0});
    EXPECT_TRUE(table.answer({up, up}).present());
    EXPECT_TRUE(table.answer({tilted(89.999), tilted(89.999)}).present());
    EXPECT_TRUE(table.answer({tilted(89.999), tilted(89.999, 0.4 + kPi)}).present());
    EXPECT_FALSE(table.answer({flat, up}).present());
    EXPECT_TRUE(table.answer({flat, up}).flags.has(Flag::BelowHorizon));
}

TEST(BakeTable, FindsTheWidthOfALobe) {
    // D falls to a half at T = 0.644 alpha; the masking hardly changes there.
    EXPECT_NEAR(halfWidthTangent(*model("ggx,alpha=0.01,f0=1")), 0.00644, 0.0008);
    EXPECT_NEAR(halfWidthTangent(*model("lambert,albedo=0.2+ggx,alpha=0.1,f0=0.5")), 0.0644, 0.008);
    EXPECT_EQ(halfWidthTangent(*model("lambert,albedo=0.2")), 1);
}

TEST(BakeTable, RefusesAxesItCannotInterpolateOn) {
    const auto lambert = model("lambert,albedo=0.2");
    for (const BoxResolution& resolution :
         {BoxResolution{1, 8, 8}, BoxResolution{8, 0, 8}, BoxResolution{8, 8, 513}}) {
        const auto table = bakeTable(*lambert, nullptr, {.resolution = resolution});
        ASSERT_FALSE(table);
        EXPECT_EQ(table.error().kind, ErrorKind::Usage);
    }
}

}  // namespace
}  // namespace gonio::proc
