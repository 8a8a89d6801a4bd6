#include "proc/optics/glare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/optics/glare_twin.h"
#include "tests/optics/lenses.h"

namespace gonio::proc {
namespace {

constexpr Radians kField = 75_deg;
// A small camera, so that the twin is done within a second: the field is a disc of 56 pixels
// radius.
const Window kWindow{.x = 0, .y = 0, .size = {120, 116}, .binning = 1};
const LensMap kLens = LensMap::fTheta({61.3, 57.8}, 0.75);
const GlareSpread kSpread{.everywhere = 0.004, .halo = 0.006, .radius = 40, .exponent = 1.2};

const FieldPixels& field() {
    static const FieldPixels pixels(kLens, kWindow, kField);
    return pixels;
}

template <class Visit>
void forEachInField(Visit visit) {
    for (int y = 0; y < field().size().height; ++y) {
        for (int x = field().inRow(y).begin; x < field().inRow(y).end; ++x) visit(x, y);
    }
}

/// A dim floor of some structure, and spots 1e5 times as bright.
Image<double> scene(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform;
    Image<double> x(kWindow.size);
    forEachInField([&](int u, int v) { x.at(u, v) = 1 + 0.5 * std::sin(0.1 * u + 0.07 * v); });
    for (int spot = 0; spot < 3; ++spot) {
        const int u = 30 + static_cast<int>(60 * uniform(random));
        const int v = 30 + static_cast<int>(55 * uniform(random));
        for (int j = 0; j < 3; ++j) {
            for (int i = 0; i < 3; ++i) x.at(u + i, v + j) = 1e5 * uniform(random);
        }
    }
    return x;
}

double sum(const Image<float>& image) {
    double all = 0;
    forEachInField([&](int x, int y) { all += double{image.at(x, y)}; });
    return all;
}

TEST(GlareFilter, MatchesReference) {
    const GlareFilter filter(kSpread, kLens, kWindow, kField);
    for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(seed);
        const Image<double> x = scene(seed);
        const Image<float> y = test::toFloat(test::withGlare(x, field(), kSpread));
        const Image<float> cleaned = filter.clean(y).radiance;
        double glare = 0, left = 0;
        forEachInField([&](int u, int v) {
            if (x.at(u, v) > 10) return;  // the spots: a float has no more digits
            const double before = double{y.at(u, v)} - x.at(u, v);
            const double after = double{cleaned.at(u, v)} - x.at(u, v);
            glare = std::max(glare, std::abs(before));
            left = std::max(left, std::abs(after));
        });
        EXPECT_GT(glare, 1) << "as bright as the floor";
        // Sources split between nodes 16 pixels apart, sums interpolated: up to
        // 2 * 16^2 / 8 * K''(0) = 64 * 2.4 / 40^2 = 10 % where the halo has its peak.
        EXPECT_LT(left, 0.10 * glare);
    }
}

TEST(GlareFilter, LosesNoLight) {
    const GlareFilter filter(kSpread, kLens, kWindow, kField);
    const Image<float> y = test::toFloat(scene(5));
    const Image<float> cleaned = filter.clean(y).radiance;
    EXPECT_NEAR(sum(cleaned) / sum(y), 1, 1e-5);  // sums of floats
}

TEST(GlareFilter, WithoutAShareThePictureIsItself) {
    const GlareFilter filter({}, kLens, kWindow, kField);
    const Image<float> y = test::toFloat(scene(7));
    EXPECT_EQ(filter.clean(y).radiance, y);
}

TEST(GlareFilter, LeavesWhatIsOutsideTheFieldAsItIs) {
    const GlareFilter filter(kSpread, kLens, kWindow, kField);
    Image<float> y = test::toFloat(scene(8));
    y.at(0, 0) = 12;
    y.at(119, 115) = std::numeric_limits<float>::quiet_NaN();
    const Image<float> cleaned = filter.clean(y).radiance;
    EXPECT_EQ(cleaned.at(0, 0), 12);
    EXPECT_TRUE(std::isnan(cleaned.at(119, 115)));
    EXPECT_EQ(filter.clean(y).filled, 0);
}

TEST(GlareFilter, ASaturatedPixelStaysMissingAndCountsAsItsBrightestNeighbour) {
    const GlareFilter filter(kSpread, kLens, kWindow, kField);
    Image<float> saturated(kWindow.size);
    forEachInField([&](int x, int y) { saturated.at(x, y) = 1; });
    Image<float> filled = saturated;
    for (const auto& [x, y] : {std::pair{60, 60}, {61, 60}}) {
        saturated.at(x, y) = std::numeric_limits<float>::quiet_NaN();
        filled.at(x, y) = 1000;
    }
    saturated.at(62, 60) = filled.at(62, 60) = 1000;
    const auto a = filter.clean(saturated);
    const auto b = filter.clean(filled);
    EXPECT_TRUE(std::isnan(a.radiance.at(60, 60)));
    EXPECT_EQ(a.radiance.at(50, 50), b.radiance.at(50, 50));
    EXPECT_GT(a.filled, 0.1);
    EXPECT_EQ(b.filled, 0);
    // All of a picture: nothing is known, and nothing is made of it.
    const auto none = filter.clean(Image<float>(kWindow.size, std::nanf("")));
    EXPECT_TRUE(std::isnan(none.radiance.at(60, 60)));
    EXPECT_EQ(none.filled, 0);
}

TEST(GlareFilter, CellsSayWhatTheCorrectionLeavesUnknown) {
    const LensMap lens = test::crookedLens();
    const Window window = test::middleWindow();
    const Binning binning(lens, window, kField);
    MergedState state{.radiance = Image<float>(window.sent(), 1),
                      .variance = Image<float>(window.sent(), 1e-4F),
                      .used = {},
                      .saturated = {},
                      .window = window};
    for (int y = 500; y < 506; ++y) {
        for (int x = 700; x < 706; ++x) state.radiance.at(x, y) = 1e6F;
    }
    const GlareSpread spread{.everywhere = 0.001, .halo = 0.001, .uRelative = 0.3};
    const GlareFilter filter(spread, lens, window, kField);
    const CellSignal seen = binning.bin(state);
    const CellSignal clean = filter.bin(state, binning);
    int flagged = 0, present = 0;
    for (std::size_t cell = 0; cell < clean.size(); ++cell) {
        ASSERT_EQ(clean.present(cell), seen.present(cell));
        if (!clean.present(cell)) continue;
        ++present;
        const double takenOff = std::abs(seen.signal[cell] - clean.signal[cell]);
        EXPECT_NEAR(clean.uGlare[cell], 0.3 * takenOff, 1e-9 * seen.signal[cell]);
        EXPECT_EQ(clean.flags[cell].has(Flag::GlareCorrected),
                  takenOff > 1e-3 * std::abs(clean.signal[cell]));
        flagged += clean.flags[cell].has(Flag::GlareCorrected) ? 1 : 0;
    }
    EXPECT_GT(flagged, present / 2) << "36 pixels of 1e6 are as much light as 40 fields of 1";
    const CellSignal untouched = GlareFilter({}, lens, window, kField).bin(state, binning);
    EXPECT_EQ(untouched.signal[5000], seen.signal[5000]);
    EXPECT_EQ(untouched.uGlare[5000], 0);
}

}  // namespace
}  // namespace gonio::proc
