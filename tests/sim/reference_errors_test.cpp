#include "sim/reference_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/random.h"

namespace gonio::sim {
namespace {

TEST(ReferenceErrors, NoneChangesNothing) {
    const ReferenceErrors none;
    EXPECT_EQ(none.white(2, Band::B, Direction()), 1);
    EXPECT_EQ(none.black(), 1);
    EXPECT_EQ(none.zero(), 0);
}

TEST(ReferenceErrors, StratifiedRunsTakeEachQuantileOnce) {
    for (std::uint64_t component : {0UL, 1UL, 2UL, 777UL}) {
        std::vector<double> seen;
        for (int run = 0; run < kStrata; ++run) {
            seen.push_back(ReferenceErrors::stratified(run).deviate(component));
        }
        std::sort(seen.begin(), seen.end());
        for (int k = 0; k < kStrata; ++k) {
            EXPECT_DOUBLE_EQ(seen[static_cast<std::size_t>(k)],
                             normalQuantile((k + 0.5) / kStrata));
        }
    }
}

TEST(ReferenceErrors, ComponentsHaveOrdersOfTheirOwn) {
    int same = 0;
    for (int run = 0; run < kStrata; ++run) {
        const ReferenceErrors errors = ReferenceErrors::stratified(run);
        same += errors.deviate(0) == errors.deviate(1) ? 1 : 0;
    }
    EXPECT_LT(same, 8);
}

TEST(ReferenceErrors, FieldHasUnitVarianceEverywhere) {
    for (double phi : {0.0, 13.0, 100.0}) {
        for (double theta : {0.0, 2.5, 33.3}) {
            const Direction wo =
                Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
            double squares = 0;
            constexpr int kSeeds = 4000;
            for (int seed = 0; seed < kSeeds; ++seed) {
                const double z =
                    ReferenceErrors::random(static_cast<std::uint64_t>(seed)).field(1, Band::G, wo);
                squares += z * z;
            }
            EXPECT_NEAR(squares / kSeeds, 1, 5 * std::sqrt(2.0 / kSeeds));
        }
    }
}

TEST(ReferenceErrors, StrataDoNotHangOnTheNoisesSeed) {
    const auto deviate = [](const char* text, std::uint64_t seed) {
        return ReferenceErrors::parse(text, seed)->deviate(0);
    };
    EXPECT_EQ(deviate("stratum:3", 1), deviate("stratum:3", 2));
    EXPECT_NE(deviate("random", 1), deviate("random", 2));
}

TEST(WhiteErrors, MatchesReference) {
    for (const ReferenceErrors& errors :
         {ReferenceErrors(), ReferenceErrors::random(11), ReferenceErrors::stratified(4)}) {
        for (int led : {0, 3}) {
            const WhiteErrors table = errors.white(led);
            for (double theta = 0; theta <= 90; theta += 4.3) {
                for (double phi = 0; phi < 360; phi += 22.5) {
                    const Direction wo = Direction::fromSpherical(Radians::fromDegrees(theta),
                                                                  Radians::fromDegrees(phi));
                    const LedBands factor = table.factor(wo);
                    // The same terms in another order: a few ulp of 1.
                    for (Band b : kBands) EXPECT_NEAR(factor[b], errors.white(led, b, wo), 1e-14);
                }
            }
        }
    }
}

TEST(ReferenceErrors, ReadsItsThreeWords) {
    EXPECT_TRUE(ReferenceErrors::parse("none", 1));
    EXPECT_TRUE(ReferenceErrors::parse("random", 1));
    EXPECT_TRUE(ReferenceErrors::parse("stratum:19", 1));
    for (const char* bad : {"", "stratum:20", "stratum:-1", "stratum:x", "some"}) {
        const auto refused = ReferenceErrors::parse(bad, 1);
        ASSERT_FALSE(refused) << bad;
        EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
    }
}

TEST(ReferenceErrors, TilesAreWrongByWhatTheirCertificatesAllow) {
    constexpr int kTiles = 4000;
    double black = 0, white = 0, zero = 0;
    for (std::uint64_t seed = 0; seed < kTiles; ++seed) {
        const ReferenceErrors errors = ReferenceErrors::random(seed);
        black += std::pow(errors.black() - 1, 2);
        zero += std::pow(errors.zero(), 2);
        EXPECT_GE(errors.zero(), 0) << "a trap gives no light less than none";
        white += std::pow(errors.white(0, Band::R, Direction()) - 1, 2);
    }
    // A variance of n samples is known to sqrt(2 / n) = 2.2 %, its root to half of that.
    EXPECT_NEAR(std::sqrt(black / kTiles), 0.1, 5 * 0.1 * 0.011);
    EXPECT_NEAR(std::sqrt(zero / kTiles), 1e-5, 5 * 1e-5 * 0.011);
    EXPECT_NEAR(std::sqrt(white / kTiles), std::hypot(0.005, 0.003), 5 * 0.0058 * 0.011);
}

}  // namespace
}  // namespace gonio::sim
