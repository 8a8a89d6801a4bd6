#include "proc/table/block_integral.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/spherical_tables.h"

namespace gonio::proc {
namespace {

using test::SphericalShape;
using test::sphericalTable;
using test::steps;

double integral(const SphericalShape& shape, double (*f)(const LightView&, std::size_t)) {
    const SphericalTable table = sphericalTable(shape, f);
    return blockIntegral(table, table.blocks[1]);
}
double lambert(const LightView&, std::size_t) { return 0.5 / kPi; }

TEST(BlockIntegral, OfALambertianIsItsAlbedoWhateverTheAxes) {
    for (const auto& azimuths : {steps(0, 360, 10), steps(0, 350, 10), steps(5, 365, 90)}) {
        for (const auto& thetas : {steps(0, 90, 5), steps(0, 90, 90), steps(0, 90, 30)}) {
            EXPECT_NEAR(
                integral({.azimuthDeg = azimuths, .thetaDeg = thetas}, lambert), 0.5, 1e-12);
        }
    }
    EXPECT_NEAR(
        integral({.planeSymmetrical = true, .azimuthDeg = steps(0, 180, 20)}, lambert), 0.5, 1e-12);
    EXPECT_NEAR(
        integral({.thetaDeg = steps(90, 180, 5), .transmission = true}, lambert), 0.5, 1e-12);
}

TEST(BlockIntegral, IsTheShareThatTheThetasCover) {
    const double sine = sin(75_deg);
    EXPECT_NEAR(integral({.thetaDeg = steps(0, 75, 5)}, lambert), 0.5 * sine * sine, 1e-12);
    const auto masked = [](const LightView& pair, std::size_t) {
        return pair.out.theta().degrees() < 57.5 ? 0.5 / kPi : std::nan("");
    };
    // Between the last node that has data and the first that has none, f falls to 0: about half.
    const double middle = sin(57.5_deg);
    EXPECT_NEAR(integral({}, masked), 0.5 * middle * middle, 1e-3);
}

TEST(BlockIntegral, ConvergesWithTheStep) {
    const auto cosine = [](const LightView& pair, std::size_t) { return pair.out.z() / kPi; };
    EXPECT_NEAR(integral({.thetaDeg = steps(0, 90, 1)}, cosine), 2.0 / 3, 1e-4);
    EXPECT_NEAR(integral({.thetaDeg = steps(0, 90, 0.25)}, cosine), 2.0 / 3, 1e-5);
}

TEST(BlockIntegral, TakesASingleAzimuthAtNormalIncidenceForTheCircle) {
    const SphericalTable table = sphericalTable({.azimuthDeg = {0}}, lambert);
    EXPECT_NEAR(blockIntegral(table, table.blocks[0]), 0.5, 1e-12);
    EXPECT_TRUE(std::isnan(blockIntegral(table, table.blocks[1])));
}

TEST(BlockIntegral, IsNoNumberWhereTheAzimuthsLeaveAGap) {
    EXPECT_TRUE(std::isnan(integral({.azimuthDeg = steps(0, 180, 10)}, lambert)));
    EXPECT_TRUE(std::isnan(integral({.azimuthDeg = {0}}, lambert)));
    EXPECT_TRUE(
        std::isnan(integral({.planeSymmetrical = true, .azimuthDeg = steps(0, 90, 10)}, lambert)));
}

}  // namespace
}  // namespace gonio::proc
