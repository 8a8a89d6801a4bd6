#include "proc/optics/binning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "tests/optics/lenses.h"

namespace gonio::proc {
namespace {

using Brdf = std::function<double(const Direction&)>;

/// What a lens without vignetting makes of f: per pixel f cos(theta_o) dOmega/dA, 2 x 2 points.
MergedState picture(const LensMap& map, const Window& window, const Brdf& f) {
    MergedState state;
    state.window = window;
    state.radiance = Image<float>(window.sent());
    state.variance = Image<float>(window.sent(), 1.0F);
    constexpr int kPoints = 2;
    for (int y = 0; y < window.sent().height; ++y) {
        for (int x = 0; x < window.sent().width; ++x) {
            double sum = 0;
            for (int j = 0; j < kPoints; ++j) {
                for (int i = 0; i < kPoints; ++i) {
                    const SensorPoint at{window.x + (x + (i + 0.5) / kPoints) * window.binning,
                                         window.y + (y + (j + 0.5) / kPoints) * window.binning};
                    const auto wo = map.directionAt(at);
                    if (!wo || wo->theta() > 76_deg) continue;
                    sum += f(*wo) * wo->z() * map.solidAnglePerPixel(at);
                }
            }
            const double area = window.binning * window.binning;
            state.radiance.at(x, y) = static_cast<float>(sum * area / (kPoints * kPoints));
        }
    }
    return state;
}

TEST(Binning, ALambertianIsEvenInEveryCell) {
    const LensMap map = test::crookedLens();
    for (const int binning : {1, 2}) {
        SCOPED_TRACE(binning);
        const Window window = test::middleWindow(binning);
        const CellSignal out =
            Binning(map, window, 75_deg).bin(picture(map, window, [](const Direction&) {
                return 0.25;
            }));
        for (std::size_t cell = 0; cell < out.size(); ++cell) {
            const int row = CellGrid::place(cell).row;
            if (row >= 75) {
                ASSERT_TRUE(out.flags[cell].has(Flag::Blocked));
                ASSERT_TRUE(std::isnan(out.signal[cell]));
                continue;
            }
            ASSERT_TRUE(out.present(cell)) << row << " " << describe(out.flags[cell]);
            // Rims of pixels are counted by 4 x 4 points.
            ASSERT_NEAR(out.signal[cell] / 0.25, 1, 0.004 * binning) << "row " << row;
        }
    }
}

TEST(Binning, GivesTheSolidAngleMeanOnASlope) {
    const LensMap map = test::crookedLens();
    const Window window = test::middleWindow();
    const Brdf f = [](const Direction& wo) { return 1 + 0.8 * wo.x() + 0.3 * wo.y(); };
    const CellSignal out = Binning(map, window, 75_deg).bin(picture(map, window, f));
    double worst = 0;
    for (std::size_t cell = 0; cell < out.size(); ++cell) {
        if (!out.present(cell)) continue;
        worst = std::max(worst, std::abs(out.signal[cell] / f(CellGrid::centre(cell)) - 1));
    }
    EXPECT_LT(worst, 0.006);
}

TEST(Binning, SharesEachPixelOnce) {
    const LensMap map = test::crookedLens();
    const Binning binning(map, test::middleWindow(), 75_deg);
    double pixels = 0;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        if (CellGrid::place(cell).row < 70) pixels += binning.pixelsIn(cell);
    }
    double inside = 0;
    for (int y = 0; y < 1024; ++y) {
        for (int x = 0; x < 1024; ++x) {
            const auto wo = map.directionAt({128 + x + 0.5, y + 0.5});
            inside += wo && wo->theta() < 70_deg ? 1 : 0;
        }
    }
    EXPECT_NEAR(pixels / inside, 1, 2e-4);
    // About 44 pixels per square degree in the middle.
    EXPECT_NEAR(
        binning.pixelsIn(*CellGrid::cellAt(Direction::fromSpherical(20.5_deg, 50_deg))), 44, 5);
}

TEST(Binning, VarianceIsThatOfRepeatedPictures) {
    const LensMap map = test::crookedLens();
    const Window window = test::middleWindow();
    const Binning binning(map, window, 75_deg);
    MergedState state = picture(map, window, [](const Direction&) { return 1.0; });
    const Image<float> clean = state.radiance;
    const double sigma = 0.05 * clean.at(512, 512);
    for (float& v : state.variance.pixels()) v = static_cast<float>(sigma * sigma);
    std::mt19937 random(11);
    std::normal_distribution<float> noise(0, static_cast<float>(sigma));
    const CellSignal ideal = binning.bin(state);
    double sum = 0;
    double count = 0;
    for (int repeat = 0; repeat < 3; ++repeat) {
        for (std::size_t i = 0; i < clean.pixels().size(); ++i) {
            state.radiance.pixels()[i] = clean.pixels()[i] + noise(random);
        }
        const CellSignal noisy = binning.bin(state);
        for (std::size_t cell = 0; cell < noisy.size(); ++cell) {
            if (!noisy.present(cell)) continue;
            sum += std::pow(noisy.signal[cell] - ideal.signal[cell], 2) / noisy.variance[cell];
            ++count;
        }
    }
    EXPECT_NEAR(sum / count, 1, 0.03);
}

TEST(Binning, SaturatedCellsAreMissing) {
    const LensMap map = test::crookedLens();
    const Window window = test::middleWindow();
    MergedState state = picture(map, window, [](const Direction&) { return 1.0; });
    const Direction lobe = Direction::fromSpherical(40.5_deg, 120_deg);
    const SensorPoint at = map.pointOf(lobe);
    for (int j = -3; j <= 3; ++j) {
        for (int i = -3; i <= 3; ++i) {
            state.radiance.at(static_cast<int>(at.x) - 128 + i, static_cast<int>(at.y) + j) =
                std::numeric_limits<float>::quiet_NaN();
        }
    }
    const CellSignal out = Binning(map, window, 75_deg).bin(state);
    const std::size_t cell = *CellGrid::cellAt(lobe);
    EXPECT_FALSE(out.present(cell));
    EXPECT_TRUE(out.flags[cell].has(Flag::Saturated));
    EXPECT_TRUE(out.present(*CellGrid::cellAt(Direction::fromSpherical(40.5_deg, 130_deg))));
}

TEST(Binning, APictureThatCutsTheFieldBlocksWhatItCuts) {
    const LensMap map = LensMap::fTheta({640, 512}, 6.6);
    const Window window{.x = 640, .y = 0, .size = {512, 1024}, .binning = 1};  // the right half
    const CellSignal out =
        Binning(map, window, 75_deg).bin(picture(map, window, [](const Direction&) {
            return 1.0;
        }));
    EXPECT_TRUE(out.present(*CellGrid::cellAt(Direction::fromSpherical(30.5_deg, 0_deg))));
    const std::size_t left = *CellGrid::cellAt(Direction::fromSpherical(30.5_deg, 180_deg));
    EXPECT_TRUE(out.flags[left].has(Flag::Blocked));
}

TEST(CellSignal, MissingIsNeverZero) {
    const CellSignal missing = CellSignal::missing(2);
    ASSERT_EQ(missing.size(), 2U);
    for (std::size_t cell = 0; cell < 2; ++cell) {
        EXPECT_FALSE(missing.present(cell));
        EXPECT_TRUE(std::isnan(missing.signal[cell]) && std::isnan(missing.variance[cell]));
    }
}

}  // namespace
}  // namespace gonio::proc
