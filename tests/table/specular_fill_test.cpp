#include "proc/table/specular_fill.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/models/spec.h"
#include "proc/table/specular_lookup.h"

namespace gonio::proc {
namespace {

std::unique_ptr<const Scatterer> model(const char* spec) { return std::move(*makeModel(spec)); }

SpecularGrid coarse(TableSymmetry symmetry) {
    SpecularGrid grid{
        .symmetry = symmetry, .incidenceDeg = {0, 20, 60}, .azimuthDeg = {}, .radialDeg = {}};
    for (double a = 0; a <= (symmetry == TableSymmetry::PlaneSymmetrical ? 180 : 360); a += 20) {
        grid.azimuthDeg.push_back(a);
    }
    for (double r = 0; r <= 180; r += 15) grid.radialDeg.push_back(r);
    return grid;
}

TEST(SpecularFill, LambertScattersItsAlbedo) {
    const auto lambert = model("lambert,albedo=0.3/0.1/0.05");
    const FilledTable filled =
        fillTable(*lambert, coarse(TableSymmetry::PlaneSymmetrical), Band::R);
    ASSERT_EQ(filled.table.planes[0].tis.size(), 3U);
    for (const double tis : filled.table.planes[0].tis) EXPECT_NEAR(tis, 0.3, 1e-12);
    EXPECT_NEAR(totalScatter(*lambert, Direction(), Band::B), 0.05, 1e-12);
}

TEST(SpecularFill, HoldsTheModelAtItsNodes) {
    const auto ggx = model("ggx,alpha=0.1,f0=0.9/0.7/0.4");
    const FilledTable filled = fillTable(*ggx, coarse(TableSymmetry::Asymmetrical), Band::B);
    auto lookup = SpecularLookup::over(filled.table);
    ASSERT_TRUE(lookup);
    const SpecularTable& table = filled.table;
    std::size_t compared = 0;
    for (TableNode n; n.incidence < 3; ++n.incidence) {
        for (n.azimuth = 0; n.azimuth < table.azimuthDeg.size(); ++n.azimuth) {
            for (n.radial = 0; n.radial < table.radialDeg.size(); ++n.radial) {
                if (!table.hasData(0, n)) continue;
                const LightView pair = table.pairAt(n);
                const double f = ggx->answer(pair).f[Band::B];
                EXPECT_NEAR(lookup->answer(pair).f[Band::R], f, 1e-9 * f);
                ++compared;
            }
        }
    }
    EXPECT_EQ(compared, filled.nodes);
    EXPECT_EQ(filled.unanswered, 0U);
    EXPECT_EQ(filled.uncertain, 0U);
}

TEST(SpecularFill, PeaksInTheMirrorDirection) {
    const auto ggx = model("ggx,alpha=0.05,f0=1");
    const FilledTable filled = fillTable(*ggx, coarse(TableSymmetry::PlaneSymmetrical), Band::G);
    const SpecularTable& table = filled.table;
    for (std::size_t incidence = 0; incidence < 3; ++incidence) {
        const double peak = table.planes[0].f[table.index({0, incidence, 0, 0})];
        for (std::size_t a = 0; a < table.azimuthDeg.size(); ++a) {
            EXPECT_NEAR(table.planes[0].f[table.index({0, incidence, a, 0})], peak, 1e-9 * peak);
            EXPECT_LT(table.planes[0].f[table.index({0, incidence, a, 1})], peak / 10);
        }
    }
}

/// Answers only within 75 degrees, there with an uncertainty; black on one side.
class Partial : public Scatterer {
public:
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        if (!pair.out.aboveHorizon() || pair.out.theta() > 75_deg) {
            return Answer::none({Flag::Blocked}, Source::Measured);
        }
        Answer answer;
        answer.f = LedBands::all(pair.out.y() > 1e-9 ? 0 : 1);
        answer.uRandom = LedBands::all(0.01);
        return answer;
    }
};

TEST(SpecularFill, CountsWhatTheTableCannotHold) {
    const FilledTable filled = fillTable(Partial(), coarse(TableSymmetry::Asymmetrical), Band::G);
    std::size_t data = 0;
    const SpecularTable& table = filled.table;
    for (const double f : table.planes[0].f) data += f != 0 ? 1U : 0U;
    EXPECT_EQ(filled.uncertain, data);
    EXPECT_GT(filled.unanswered, 0U);
    EXPECT_GT(filled.exactZero, 0U);
    EXPECT_EQ(filled.nodes, filled.unanswered + filled.exactZero + filled.uncertain);
}

TEST(SpecularFill, OneDegreeGridIsTheDefaultOfTheFormat) {
    const SpecularGrid half = SpecularGrid::oneDegree({0, 20}, TableSymmetry::PlaneSymmetrical);
    EXPECT_EQ(half.azimuthDeg.size(), 181U);
    EXPECT_EQ(half.radialDeg.size(), 181U);
    const SpecularGrid full = SpecularGrid::oneDegree({0}, TableSymmetry::Asymmetrical);
    EXPECT_EQ(full.azimuthDeg.size(), 361U);
    EXPECT_EQ(full.azimuthDeg.back(), 360);
}

TEST(SpecularFill, AnEmptyGridGivesAnEmptyTable) {
    const FilledTable filled = fillTable(Partial(), {}, Band::G);
    EXPECT_EQ(filled.nodes, 0U);
    EXPECT_TRUE(filled.table.planes[0].f.empty());
}

}  // namespace
}  // namespace gonio::proc
