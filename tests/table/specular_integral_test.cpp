#include "proc/table/specular_integral.h"

#include <gtest/gtest.h>

#include "proc/core/scatterer.h"
#include "proc/table/specular_fill.h"

namespace gonio::proc {
namespace {

class Lambert : public Scatterer {
public:
    [[nodiscard]] Answer answer(const LightView&) const override {
        Answer answer;
        answer.f = LedBands::all(0.5 / kPi);
        return answer;
    }
    [[nodiscard]] BandCount bandCount() const override { return BandCount::One; }
};

/// Panes are 1 degree wide, and those that the horizon cuts are taken whole or not at all.
TEST(SpecularIntegral, OfALambertianIsItsAlbedo) {
    for (const TableSymmetry symmetry :
         {TableSymmetry::PlaneSymmetrical, TableSymmetry::Asymmetrical}) {
        const auto grid = SpecularGrid::oneDegree({0, 20, 60, 80}, symmetry);
        const SpecularTable table = fillTable(Lambert(), grid, Band::R).table;
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(specularIntegral(table, 0, {.incidence = i}), 0.5, 0.5 * 2e-4)
                << grid.incidenceDeg[i];
        }
    }
}

TEST(SpecularIntegral, CountsWhatIsMissingAsNothing) {
    const auto grid = SpecularGrid::oneDegree({30}, TableSymmetry::Asymmetrical);
    SpecularTable table = fillTable(Lambert(), grid, Band::R).table;
    for (std::size_t a = 0; a < table.azimuthDeg.size(); ++a) {
        const bool half = table.azimuthDeg[a] > 180;
        for (std::size_t r = 1; r < table.radialDeg.size() && half; ++r) {
            table.planes[0].f[table.index({0, 0, a, r})] = 0;
        }
    }
    EXPECT_NEAR(specularIntegral(table, 0, {}), 0.25, 2e-3);
    table.planes[0].f.assign(table.nodeCount(), 0);
    EXPECT_EQ(specularIntegral(table, 0, {}), 0);
}

std::vector<double> centres(double step, double last) {
    std::vector<double> axis;
    for (double at = step / 2; at < last; at += step) axis.push_back(at);
    return axis;
}

TEST(SpecularIntegral, OfCellsGoesOnToThePoleAndTheMirrorPlane) {
    for (const bool half : {true, false}) {
        const SpecularGrid grid{
            .symmetry = half ? TableSymmetry::PlaneSymmetrical : TableSymmetry::Asymmetrical,
            .incidenceDeg = {0, 20, 60, 80},
            .azimuthDeg = centres(1, half ? 180 : 360),
            .radialDeg = centres(1, 180)};
        const SpecularTable table = fillTable(Lambert(), grid, Band::R).table;
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(specularIntegral(table, 0, {.incidence = i}), 0.5, 0.5 * 2e-4)
                << grid.incidenceDeg[i];
        }
    }
}

/// Azimuths 0..180 of a table without symmetry: the other half was not measured.
TEST(SpecularIntegral, DoesNotCloseAWideGap) {
    SpecularGrid grid = SpecularGrid::oneDegree({20}, TableSymmetry::PlaneSymmetrical);
    grid.symmetry = TableSymmetry::Asymmetrical;
    const SpecularTable half = fillTable(Lambert(), grid, Band::R).table;
    EXPECT_NEAR(specularIntegral(half, 0, {}), 0.25, 1e-4);
    grid.azimuthDeg.clear();
    for (int azimuth = 0; azimuth < 360; ++azimuth) grid.azimuthDeg.push_back(azimuth);
    const SpecularTable open = fillTable(Lambert(), grid, Band::R).table;
    EXPECT_NEAR(specularIntegral(open, 0, {}), 0.5, 1e-4);
    grid.azimuthDeg = {0};
    EXPECT_EQ(specularIntegral(fillTable(Lambert(), grid, Band::R).table, 0, {}), 0);
}

}  // namespace
}  // namespace gonio::proc
