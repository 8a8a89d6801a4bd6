#include "proc/table/warp2d.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace gonio::proc {
namespace {

/// Two slices of 7 x 5 nodes.
GridStack smallDensity() {
    GridStack stack{.width = 7, .height = 5, .values = {}};
    std::mt19937_64 random(2);
    std::uniform_real_distribution<float> any(0, 3);
    for (int i = 0; i < 2 * 35; ++i) stack.values.push_back(i % 9 == 0 ? 0.0F : any(random));
    return stack;
}

Warp2d warpOf(GridStack stack) {
    auto warp = Warp2d::over(std::move(stack));
    EXPECT_TRUE(warp);
    return std::move(*warp);
}

const SliceBlend kBetween{.slice = {0, 1, 0, 0}, .share = {0.3, 0.7, 0, 0}};

TEST(Bilinear, IsExactForWhatIsBilinear) {
    GridStack stack{.width = 4, .height = 3, .values = {}};
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 4; ++x) stack.values.push_back(static_cast<float>(x + 10 * y + x * y));
    }
    EXPECT_NEAR(bilinear(stack, 0, {.x = 0.5, .y = 0.25}), 1.5 + 5 + 0.75, 1e-12);
    EXPECT_EQ(bilinear(stack, 0, {.x = 1, .y = 1}), 3 + 20 + 6);
    EXPECT_EQ(bilinear(stack, 0, {.x = 2, .y = -1}), 3);  // the edge's value beyond it
}

TEST(Warp2d, InvertsWhatItSamples) {
    const Warp2d warp = warpOf(smallDensity());
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const SquarePoint uniform{.x = unit(random), .y = unit(random)};
        const SquarePoint at = warp.sample(uniform, kBetween);
        const SquarePoint back = warp.invert(at, kBetween);
        // Sums are stored as floats.
        ASSERT_NEAR(back.x, uniform.x, 2e-6);
        ASSERT_NEAR(back.y, uniform.y, 2e-6);
    }
}

TEST(Warp2d, HasTheDensityOfItsSamples) {
    const Warp2d warp = warpOf(smallDensity());
    // The area that a small square becomes: its inverse is the density.
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> unit(0.01, 0.98);
    constexpr double kStep = 1e-3;
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
        const SquarePoint at{.x = unit(random), .y = unit(random)};
        const auto insideOneCell = [](double low, double cells) {
            return std::floor(low * cells) == std::floor((low + kStep) * cells);
        };
        if (!insideOneCell(at.x, 6) || !insideOneCell(at.y, 4)) continue;
        ++compared;
        const SquarePoint a = warp.invert(at, kBetween);
        const SquarePoint right = warp.invert({at.x + kStep, at.y}, kBetween);
        const SquarePoint up = warp.invert({at.x, at.y + kStep}, kBetween);
        const double area = ((right.x - a.x) * (up.y - a.y) - (right.y - a.y) * (up.x - a.x));
        const double density = warp.density({at.x + kStep / 2, at.y + kStep / 2}, kBetween);
        ASSERT_NEAR(area / (kStep * kStep), density, 0.02 * density + 0.01);
    }
    EXPECT_GT(compared, 200);
}

TEST(Warp2d, IsTheIdentityOfAnEvenDensity) {
    const Warp2d warp = warpOf({.width = 3, .height = 4, .values = std::vector<float>(12, 5.0F)});
    const SquarePoint at = warp.sample({0.3, 0.8}, {});
    EXPECT_NEAR(at.x, 0.3, 1e-6);
    EXPECT_NEAR(at.y, 0.8, 1e-6);
    EXPECT_NEAR(warp.density({0.1, 0.2}, {}), 1, 1e-6);
}

TEST(Warp2d, MapsTheCornersToThemselves) {
    const Warp2d warp = warpOf(smallDensity());
    for (const double x : {0.0, 1.0}) {
        for (const double y : {0.0, 1.0}) {
            const SquarePoint back = warp.invert({x, y}, {});
            EXPECT_NEAR(back.x, x, 1e-6);
            EXPECT_NEAR(back.y, y, 1e-6);
        }
    }
}

TEST(Warp2d, StaysFiniteInRowsWithoutDensity) {
    GridStack stack{.width = 3, .height = 4, .values = std::vector<float>(12, 0.0F)};
    stack.values[1] = 1;
    const Warp2d warp = warpOf(stack);
    for (double y = 0; y <= 1; y += 0.125) {
        const SquarePoint back = warp.invert({0.25, y}, {});
        EXPECT_TRUE(std::isfinite(back.x) && std::isfinite(back.y)) << y;
        const SquarePoint at = warp.sample({0.25, y}, {});
        EXPECT_TRUE(std::isfinite(at.x) && std::isfinite(at.y)) << y;
    }
}

TEST(Warp2d, RefusesWhatIsNoDensity) {
    const GridStack sound = smallDensity();
    const auto refused = [&](float value) {
        GridStack stack = sound;
        stack.values[40] = value;
        return !Warp2d::over(stack);
    };
    EXPECT_FALSE(refused(1));
    EXPECT_TRUE(refused(-1e-6F));
    EXPECT_TRUE(refused(std::numeric_limits<float>::quiet_NaN()));
    EXPECT_TRUE(refused(std::numeric_limits<float>::infinity()));
    GridStack none{.width = 3, .height = 3, .values = std::vector<float>(9, 0.0F)};
    EXPECT_FALSE(Warp2d::over(none));
    none.values.assign(9, std::numeric_limits<float>::max());  // whose sum is beyond a float
    EXPECT_FALSE(Warp2d::over(none));
    EXPECT_FALSE(Warp2d::over({.width = 1, .height = 9, .values = std::vector<float>(9, 1.0F)}));
    EXPECT_FALSE(Warp2d::over({}));
}

}  // namespace
}  // namespace gonio::proc
