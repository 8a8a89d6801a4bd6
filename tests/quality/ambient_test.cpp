#include "proc/quality/ambient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/optics/lenses.h"

namespace gonio::proc {
namespace {

constexpr Radians kField = 75_deg;
const SensorNoise kNoise;

/// A mean of dark frames of 40 ms, with noise of pixels and columns, and `electrons` more where the
/// lens shows anything.
DarkFrame darkFrame(double electrons) {
    const Window window = test::middleWindow();
    const LensMap lens = test::crookedLens();
    DarkFrame dark{.mean = Image<float>(window.size),
                   .hot = {{.x = 512, .y = 512, .excessDn = 3000}},
                   .exposure = {.granted = Nanoseconds(40'000'000)},
                   .window = window,
                   .frames = 4};
    std::mt19937 random(5);
    std::normal_distribution<float> pixel(0, 0.6F), column(0, 0.1F);
    for (int x = 0; x < window.size.width; ++x) {
        const float level = 60 + column(random);
        for (int y = 0; y < window.size.height; ++y) {
            const auto wo = lens.directionAt({window.x + x + 0.5, window.y + y + 0.5});
            const bool lit = wo && wo->theta() < 76_deg;
            dark.mean.at(x, y) = level + pixel(random) +
                                 (lit ? static_cast<float>(electrons / kNoise.electronsPerDn) : 0);
        }
    }
    dark.mean.at(512, 512) += 3000;
    return dark;
}

double pixelsOfField() {
    const Window window = test::middleWindow();
    const LensMap lens = test::crookedLens();
    double pixels = 0;
    for (int y = 0; y < window.size.height; ++y) {
        for (int x = 0; x < window.size.width; ++x) {
            const auto wo = lens.directionAt({window.x + x + 0.5, window.y + y + 0.5});
            pixels += wo && wo->theta() < kField ? 1 : 0;
        }
    }
    return pixels;
}

TEST(Ambient, IsFoundWithinItsUncertaintyHotPixelsAndColumnsOrNot) {
    const double pixels = pixelsOfField();
    for (const double electrons : {0.0, 20.0}) {
        const auto light = ambientLight(darkFrame(electrons), test::crookedLens(), kField, kNoise);
        ASSERT_TRUE(light);
        const double truth = electrons / 0.04 * pixels;
        EXPECT_NEAR(light->perSecond, truth, 4 * light->u) << electrons;
        // Columns of 0.26 electrons, about a thousand of them on either side.
        EXPECT_LT(light->u, 0.03 / 0.04 * pixels);
    }
}

TEST(Ambient, NothingIsSaidWhereTheWindowShowsOneSideAlone) {
    DarkFrame dark = darkFrame(0);
    dark.window.x += 10'000;
    EXPECT_FALSE(ambientLight(dark, test::crookedLens(), kField, kNoise));
    dark.window = {.x = 545, .y = 412, .size = {200, 200}};
    dark.mean = Image<float>(dark.window.size, 60);
    dark.hot.clear();
    EXPECT_FALSE(ambientLight(dark, test::crookedLens(), kField, kNoise));
}

CellSignal signalOf(double level) {
    CellSignal signal = CellSignal::missing(CellGrid::count());
    for (std::size_t cell = 0; cell < signal.size(); ++cell) {
        if (CellGrid::place(cell).row >= 75) continue;
        signal.signal[cell] = level;
        signal.variance[cell] = 1;
        signal.flags[cell] = Flags{Flag::Measured};
    }
    return signal;
}

TEST(Ambient, FieldSignalIsTheGainOverTheProjectedSolidAngle) {
    const auto white = ReferenceTable::lambertian("white", 0.9, 0.01);
    const auto black = ReferenceTable::lambertian("black", 0.1, 0.01);
    const CellSignal bright = signalOf(1100), dim = signalOf(100);
    const auto signal = fieldSignal(
        {bright, dim, white, black}, Direction::fromSpherical(20_deg, Radians(0)), Band::G);
    ASSERT_TRUE(signal);
    const double gain = 1000 / (0.8 / kPi);
    EXPECT_NEAR(*signal, gain * kPi * std::pow(std::sin(75 * kPi / 180), 2), 1e-3 * *signal);
    EXPECT_FALSE(fieldSignal(
        {dim, bright, white, black}, Direction::fromSpherical(20_deg, Radians(0)), Band::G));
}

TEST(Ambient, IsGradedByTheLightOfAThousandth) {
    const double perF = 1e6;  // a thousandth: 1000 electrons a second
    const auto grade = [&](double perSecond, double u) {
        return ambientVerdict(AmbientLight{perSecond, u}, perF).grade;
    };
    EXPECT_EQ(grade(0.9, 0.01), Grade::Ok);
    EXPECT_EQ(grade(1.1, 0.01), Grade::Warned);
    EXPECT_EQ(grade(1.1, 0.3), Grade::Ok) << "below five standard uncertainties";
    EXPECT_EQ(grade(-5, 0.01), Grade::Ok);
    EXPECT_EQ(grade(1001, 0.01), Grade::Refused);
    EXPECT_EQ(ambientVerdict({}, perF).grade, Grade::NotDetermined);
    EXPECT_EQ(ambientVerdict(AmbientLight{}, {}).grade, Grade::NotDetermined);
}

}  // namespace
}  // namespace gonio::proc
