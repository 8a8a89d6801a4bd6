#include "proc/fit/family.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "proc/models/spec.h"
#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

/// Anywhere within the bounds, on them in one draw of six.
FamilyPoint drawn(const Family& family, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const auto value = [&](const FamilyParameter& p) {
        const double where = unit(random);
        if (where < 1.0 / 12) return p.lower;
        if (where > 11.0 / 12) return p.upper;
        if (p.scale == ParameterScale::Linear) return p.lower + where * (p.upper - p.lower);
        return p.lower * std::pow(p.upper / p.lower, where);
    };
    FamilyPoint point;
    for (const FamilyParameter& p : family.parameters()) {
        if (p.perBand) {
            point.perBand.push_back({{value(p), value(p), value(p)}});
        } else {
            point.shared.push_back(value(p));
        }
    }
    return point;
}

WeightedNode nodeAt(const LightView& pair) { return {pairOf<double>(pair), 1}; }

/// Random pairs, and pairs near the mirror direction, where lobes are.
LightView pairDrawn(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const Direction in = test::randomDirection(random);
    if (unit(random) < 0.5) return {.in = in, .out = test::randomDirection(random)};
    const Eigen::Vector3d off(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
    const auto out = Direction::fromVector(mirrorOf(in).vector() + 0.1 * off);
    return out && out->aboveHorizon() ? LightView{in, *out} : LightView{in, mirrorOf(in)};
}

TEST(Family, SlopesAreFiniteEverywhereWithinTheBounds) {
    for (const auto& family : families()) {
        std::mt19937_64 random(11);
        for (int i = 0; i < 4000; ++i) {
            const FamilyPoint point = drawn(*family, random);
            const WeightedNode node = nodeAt(pairDrawn(random));
            for (const BandSlopes& f : family->slopes(point, std::span(&node, 1))) {
                ASSERT_TRUE(std::isfinite(f.value)) << family->name();
                for (const double s : f.slope) ASSERT_TRUE(std::isfinite(s)) << family->name();
            }
        }
    }
}

TEST(Family, SlopesMatchCentralDifferences) {
    for (const auto& family : families()) {
        std::mt19937_64 random(12);
        int compared = 0;
        for (int i = 0; i < 400; ++i) {
            const FamilyPoint point = drawn(*family, random);
            const WeightedNode node = nodeAt(pairDrawn(random));
            const std::span nodes(&node, 1);
            const auto slopes = family->slopes(point, nodes);
            EXPECT_NEAR(slopes[0].value,
                        family->f(point, nodes)[Band::R],
                        1e-12 * std::abs(slopes[0].value));
            for (std::size_t k = 0; k < family->sharedCount(); ++k) {
                const double p = point.shared[k];
                const double step = 1e-6 * std::max(p, 1e-3);
                // A step across a kink tells nothing: the two one-sided slopes must agree.
                const auto moved = [&](double by) {
                    FamilyPoint there = point;
                    there.shared[k] += by;
                    return family->f(there, nodes)[Band::R];
                };
                const double up = (moved(step) - moved(0)) / step;
                const double down = (moved(0) - moved(-step)) / step;
                const double size = std::max(std::abs(up), std::abs(slopes[0].value) / p * 1e-3);
                if (!(std::abs(up - down) < 1e-3 * size + 1e-9)) continue;
                ++compared;
                // Rounding of f over the step, and the step squared.
                EXPECT_NEAR(slopes[0].slope[k],
                            (up + down) / 2,
                            1e-4 * size + 1e-9 + 1e-9 * std::abs(slopes[0].value) / step * 1e-6)
                    << family->name() << " " << family->parameters()[k].name << " " << p;
            }
        }
        EXPECT_TRUE(family->sharedCount() == 0 || compared > 200) << family->name();
    }
}

TEST(Family, EachBandIsAffineInItsOwnParametersAlone) {
    for (const auto& family : families()) {
        std::mt19937_64 random(13);
        for (int i = 0; i < 100; ++i) {
            const FamilyPoint point = drawn(*family, random);
            const WeightedNode node = nodeAt(pairDrawn(random));
            const std::span nodes(&node, 1);
            const auto at = family->slopes(point, nodes);
            for (std::size_t k = 0; k < family->perBandCount(); ++k) {
                FamilyPoint moved = point;
                moved.perBand[k][Band::G] += 0.25;
                const auto there = family->slopes(moved, nodes);
                const double slope = at[1].slope[family->sharedCount() + k];
                EXPECT_NEAR(there[1].value,
                            at[1].value + 0.25 * slope,
                            1e-12 * (std::abs(at[1].value) + std::abs(slope)))
                    << family->name();
                EXPECT_EQ(there[0].value, at[0].value);
                EXPECT_EQ(there[2].value, at[2].value);
            }
        }
    }
}

/// The trapezoid rule over a period converges beyond all powers: 2,000 places are exact to
/// rounding.
TEST(WardAveraged, IsTheMeanOfWardOverRotationsOfTheSample) {
    std::mt19937_64 random(14);
    for (const char* widths : {"alpha_x=0.1,alpha_y=0.3", "alpha_x=0.5,alpha_y=0.05"}) {
        const std::string spec = std::string("ward,ks=0.5,") + widths;
        const auto fixed = makeModel(spec);
        const auto averaged = makeModel(spec + ",azimuth=averaged");
        ASSERT_TRUE(fixed && averaged);
        for (int i = 0; i < 50; ++i) {
            const LightView pair = pairDrawn(random);
            constexpr int kTurns = 2000;
            double mean = 0;
            for (int k = 0; k < kTurns; ++k) {
                const Radians turn(2 * kPi * k / kTurns);
                mean += (*fixed)->answer({pair.in.turned(turn), pair.out.turned(turn)}).f[Band::G];
            }
            mean /= kTurns;
            EXPECT_NEAR((*averaged)->answer(pair).f[Band::G], mean, 1e-10 * mean + 1e-14);
        }
    }
}

TEST(Family, NamesAreKnownAndDifferent) {
    std::set<std::string> names;
    for (const auto& family : families()) {
        names.insert(family->name());
        EXPECT_EQ(*familyNamed(family->name()), family.get());
    }
    EXPECT_EQ(names.size(), families().size());
    EXPECT_GE(names.size(), 18U);
    EXPECT_EQ(familiesNamed("all")->size(), families().size());
    EXPECT_EQ(familiesNamed("ggx,lambert,ggx")->size(), 2U);
}

TEST(Family, UnknownNamesAreUsageErrorsThatListTheKnown) {
    for (const char* list : {"banana", "", "ggx,", ",", "ggx,banana"}) {
        const auto chosen = familiesNamed(list);
        ASSERT_FALSE(chosen) << list;
        EXPECT_EQ(chosen.error().kind, ErrorKind::Usage);
        EXPECT_NE(chosen.error().message.find("lambert+ggx"), std::string::npos);
    }
}

}  // namespace
}  // namespace gonio::proc
