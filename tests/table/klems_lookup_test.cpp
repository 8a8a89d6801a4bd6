#include "proc/table/klems_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

KlemsBasis full() { return *knownKlemsBasis("LBNL/Klems Full"); }

/// f = value(incident patch, outgoing patch) for one face.
template <class Value>
KlemsTable tableOf(const KlemsBasis& basis, KlemsFace face, bool transmission, const Value& value) {
    KlemsTable table{.bases = {basis}, .matrices = {}};
    KlemsMatrix matrix{.face = face, .transmission = transmission, .spectrum = "Visible", .f = {}};
    for (std::size_t out = 0; out < basis.patchCount(); ++out) {
        for (std::size_t in = 0; in < basis.patchCount(); ++in) matrix.f.push_back(value(in, out));
    }
    table.matrices.push_back(std::move(matrix));
    return table;
}

TEST(KlemsBasis, CoversTheHemisphere) {
    for (const auto& [name, patches] : {std::pair("Full", 145U), {"Half", 73U}, {"Quarter", 41U}}) {
        const auto basis = knownKlemsBasis(std::string("LBNL/Klems ") + name);
        ASSERT_TRUE(basis);
        EXPECT_EQ(basis->patchCount(), patches);
        double sum = 0;
        for (std::size_t i = 0; i < patches; ++i) sum += basis->projectedSolidAngle(i);
        EXPECT_NEAR(sum, kPi, 1e-12);
    }
    EXPECT_FALSE(knownKlemsBasis("LBNL/Shirley-Chiu"));
}

TEST(KlemsBasis, CentresItsFirstAzimuthOnZero) {
    const KlemsBasis basis = full();
    const auto patch = [&](double theta, double phi) {
        return basis.patchOf(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
    };
    EXPECT_EQ(patch(0, 0), 0U);
    EXPECT_EQ(patch(4.9, 200), 0U);
    EXPECT_EQ(patch(10, 22), 1U);
    EXPECT_EQ(patch(10, 23), 2U);
    EXPECT_EQ(patch(10, 338), 1U);
    EXPECT_EQ(patch(10, 337), 8U);
    EXPECT_EQ(patch(10, -23), 8U);
    EXPECT_EQ(patch(10, 720 + 23), 2U);
    EXPECT_EQ(patch(15, 0), 9U);
    EXPECT_EQ(patch(90, 0), 133U);
    EXPECT_EQ(patch(89, 330), 144U);
    EXPECT_FALSE(patch(90.1, 0));
    EXPECT_TRUE(basis.isCentre(82.5_deg, 330_deg));
    EXPECT_TRUE(basis.isCentre(0_deg, 77_deg));
    EXPECT_FALSE(basis.isCentre(2.5_deg, 0_deg));
    EXPECT_FALSE(basis.isCentre(82.5_deg, 331_deg));
}

TEST(KlemsTable, ScattersTheAlbedoOfALambertian) {
    const KlemsTable table =
        tableOf(full(), KlemsFace::Front, false, [](auto, auto) { return 0.4 / kPi; });
    for (const double share : table.hemispherical(table.matrices[0]))
        EXPECT_NEAR(share, 0.4, 1e-12);
}

TEST(KlemsLookup, HasTheMirrorAndTheStraightWayOnItsDiagonal) {
    std::mt19937_64 random(5);
    for (const KlemsFace face : {KlemsFace::Front, KlemsFace::Back}) {
        for (const bool transmission : {false, true}) {
            const auto lookup =
                KlemsLookup::over(tableOf(full(),
                                          face,
                                          transmission,
                                          [](auto in, auto out) { return in == out ? 1 : 0; }),
                                  {.face = face});
            ASSERT_TRUE(lookup);
            for (int i = 0; i < 1000; ++i) {
                const Direction wi = Direction::fromSpherical(
                    Radians(std::uniform_real_distribution<double>(0, 1.57)(random)),
                    Radians(std::uniform_real_distribution<double>(0, 6.28)(random)));
                const Direction wo =
                    transmission ? *Direction::fromVector(-wi.vector()) : mirrorOf(wi);
                EXPECT_EQ(lookup->answer({.in = wi, .out = wo}).f[Band::G], 1);
            }
        }
    }
}

TEST(KlemsLookup, TellsLeftFromRight) {
    // Light from +x: incident patch 5 of 1..8 (phi 0 + 180). Outgoing patch 3 lies at phi 90.
    const auto value = [](std::size_t in, std::size_t out) {
        return static_cast<double>(1000 * in + out);
    };
    const LightView pair{.in = Direction::fromSpherical(10_deg, 0_deg),
                         .out = Direction::fromSpherical(10_deg, 90_deg)};
    const auto front = KlemsLookup::over(tableOf(full(), KlemsFace::Front, false, value), {});
    ASSERT_TRUE(front);
    const Answer answer = front->answer(pair);
    EXPECT_EQ(answer.f[Band::R], 5003);
    EXPECT_EQ(answer.source, Source::Measured);
    EXPECT_EQ(
        front->answer({.in = pair.in, .out = Direction::fromSpherical(12_deg, 90_deg)}).source,
        Source::Interpolated);
    // From behind, +x is the front's -x: incident patch 1, and phi 90 stays.
    const auto back = KlemsLookup::over(tableOf(full(), KlemsFace::Back, false, value),
                                        {.face = KlemsFace::Back});
    ASSERT_TRUE(back);
    EXPECT_EQ(back->answer(pair).f[Band::R], 1003);
}

TEST(KlemsLookup, AnswersOnlyForWhatTheTableHas) {
    const KlemsTable table = tableOf(full(), KlemsFace::Front, false, [](auto, auto) { return 1; });
    const auto lookup = KlemsLookup::over(table, {});
    ASSERT_TRUE(lookup);
    const Direction up;
    const Direction down = *Direction::fromVector(-up.vector());
    EXPECT_TRUE(lookup->answer({.in = up, .out = up}).present());
    EXPECT_EQ(lookup->answer({.in = up, .out = down}).flags, Flags{Flag::BelowHorizon});
    EXPECT_EQ(lookup->answer({.in = down, .out = up}).flags, Flags{Flag::BelowHorizon});
    const auto solar = KlemsLookup::over(table, {.spectrum = "Solar"});
    ASSERT_FALSE(solar);
    EXPECT_EQ(solar.error().kind, ErrorKind::File);
    EXPECT_NE(solar.error().message.find("the table has Visible front"), std::string::npos);
    KlemsTable damaged = table;
    damaged.matrices[0].f.pop_back();
    EXPECT_FALSE(KlemsLookup::over(damaged, {}));
    damaged = table;
    damaged.matrices[0].outgoing = 1;
    EXPECT_FALSE(KlemsLookup::over(damaged, {}));
}

}  // namespace
}  // namespace gonio::proc
