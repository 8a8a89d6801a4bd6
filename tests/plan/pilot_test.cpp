// Cells of a pilot from a binned picture.

#include "proc/plan/pilot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace gonio;
using namespace gonio::proc;

TEST(PilotCells, GiveBackTheRateOfAPixel) {
    const Window window{.size = {256, 256}};
    const LensMap lens = LensMap::fTheta({128, 128}, 6.6);
    const Binning binning(lens, window, Radians::fromDegrees(15));
    constexpr double kRate = 5e4;
    MergedState state;
    state.window = window;
    state.radiance = Image<float>(window.size);
    state.variance = Image<float>(window.size);
    for (float& x : state.radiance.pixels()) x = static_cast<float>(kRate);
    for (float& v : state.variance.pixels()) v = 1;
    CellSignal signal = binning.bin(state);
    const std::size_t cell = CellGrid::index({.row = 10, .sector = 5});
    const std::size_t bright = CellGrid::index({.row = 11, .sector = 5});
    ASSERT_TRUE(signal.present(cell));
    signal.flags[bright] = Flags{Flag::Saturated};
    const std::vector<double> perF(signal.size(), signal.signal[cell] / 0.2);
    const std::vector<double> dark(signal.size(), 0.0);
    const std::vector<PlanCell> cells =
        pilotCells(signal, {.signalPerF = perF, .dark = dark}, binning);
    // Cosine and solid angle vary by 1 % over a cell; pixels at its edge are shared by points.
    EXPECT_NEAR(cells[cell].rate, kRate, 0.03 * kRate);
    EXPECT_NEAR(cells[cell].f, 0.2, 1e-12);
    EXPECT_EQ(cells[cell].pixels, signal.nEff[cell]);
    EXPECT_TRUE(cells[cell].usable());
    EXPECT_TRUE(cells[bright].blinding());
    EXPECT_EQ(cells[CellGrid::index({.row = 40, .sector = 0})].count, 0);  // out of the field
}

}  // namespace
