#include "proc/radiance/scale_system.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace gonio::proc {
namespace {

constexpr double kSigma = 0.05;

/// Three nodes of the given scales over pixels of different light; the first sees the dim half
/// only.
ScaleSystem threeNodes(const std::array<double, 3>& scale, std::mt19937_64& random) {
    std::normal_distribution<double> noise(0, kSigma);
    ScaleSystem system(3);
    for (int p = 0; p < 4000; ++p) {
        const double light = p % 2 == 0 ? 1 : 4;
        std::array<double, 3> rate{}, weight{};
        for (std::size_t i = p % 2 == 0 ? 0 : 1; i < 3; ++i) {
            rate[i] = scale[i] * light + noise(random);
            weight[i] = 1 / (kSigma * kSigma);
        }
        system.add(light, rate, weight);
    }
    return system;
}

TEST(ScaleSystem, FindsAnOffsetAndItsUncertainty) {
    std::mt19937_64 random(4);
    double squares = 0;
    constexpr int kRepeats = 200;
    for (int i = 0; i < kRepeats; ++i) {
        const auto offset = threeNodes({1, 1, 1.01}, random).along(Eigen::Vector3d{0, 0, 1});
        ASSERT_TRUE(offset);
        const double pull = (offset->size - 0.01) / offset->u;
        squares += pull * pull / kRepeats;
    }
    EXPECT_NEAR(squares, 1, 5 * std::sqrt(2.0 / kRepeats));
}

TEST(ScaleSystem, SolveSharesTheOffsetByWhatIsKnownBeforehand) {
    std::mt19937_64 random(5);
    // The third is known to 1e-5: the others are found against it.
    const auto found =
        threeNodes({1.02, 0.99, 1}, random).solve(std::array<double, 3>{0.1, 0.1, 1e-5});
    ASSERT_EQ(found.size(), 3U);
    EXPECT_NEAR(found[0].size, 0.02, 5 * found[0].u + 0.02 * 0.02);
    EXPECT_NEAR(found[1].size, -0.01, 5 * found[1].u + 0.01 * 0.02);
    EXPECT_NEAR(found[2].size, 0, 5e-5);
    // 2000 pixels of light 1 and noise 0.05 in both: sqrt(2 x 0.05^2 / 2000) = 0.16 %.
    EXPECT_NEAR(found[0].u, 0.0016, 0.0004);
    // The other way round the third one moves.
    const auto moved =
        threeNodes({1, 1, 1.02}, random).solve(std::array<double, 3>{1e-5, 1e-5, 0.1});
    EXPECT_NEAR(moved[2].size, 0.02, 5 * moved[2].u + 0.02 * 0.02);
    EXPECT_NEAR(moved[0].size, 0, 5e-5);
}

TEST(ScaleSystem, WithoutPixelsInCommonNothingIsKnown) {
    ScaleSystem system(2);
    EXPECT_FALSE(system.along(Eigen::Vector2d{0, 1}));
    system.add(1, std::array{1.0, 0.0}, std::array{1.0, 0.0});
    system.add(1, std::array{0.0, 1.0}, std::array{0.0, 1.0});
    system.add(0, std::array{1.0, 1.0}, std::array{1.0, 1.0});  // no light
    EXPECT_FALSE(system.along(Eigen::Vector2d{0, 1}));
    const auto offsets = system.solve(std::array{0.01, 0.02});
    EXPECT_EQ(offsets[0].size, 0);
    EXPECT_NEAR(offsets[0].u, 0.01, 1e-12);
    EXPECT_NEAR(offsets[1].u, 0.02, 1e-12);
    // What all have in common is not in the pictures.
    std::mt19937_64 random(6);
    EXPECT_FALSE(threeNodes({1.1, 1.1, 1.1}, random).along(Eigen::Vector3d{0, 0, 0}));
}

TEST(ScaleSystem, ABlockSaysWhatItsPixelsSay) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> some(0.5, 2);
    ScaleSystem blocks(3), pixels(3);
    for (int block = 0; block < 20; ++block) {
        BlockOfPixels light{};
        std::array<NodeBlock, 3> nodes;
        for (std::size_t x = 0; x < kBlock; ++x) {
            light[x] = x % 7 == 0 ? 0 : some(random);
            std::array<double, 3> rate{}, weight{};
            for (std::size_t i = x % 5 == 0 ? 2 : x % 3 == 0 ? 1 : 0; i < 3; ++i) {
                rate[i] = light[x] * (i == 2 ? 1.02 : 1) + 0.1 * (some(random) - 1);
                weight[i] = some(random);
                nodes[i].rate[x] = rate[i];
                nodes[i].weight[x] = weight[i];
            }
            pixels.add(light[x], rate, weight);
        }
        blocks.add(light, std::array<const NodeBlock*, 3>{&nodes[0], &nodes[1], &nodes[2]});
    }
    for (const Eigen::Vector3d& pattern : {Eigen::Vector3d{0, 0, 1}, Eigen::Vector3d{0, 1, 1}}) {
        const auto fast = blocks.along(pattern), slow = pixels.along(pattern);
        ASSERT_TRUE(fast && slow);
        EXPECT_NEAR(fast->size, slow->size, 1e-12);
        EXPECT_NEAR(fast->u, slow->u, 1e-12);
    }
}

TEST(ScaleSystem, TheLightOfABlockIsThatAroundItsPixels) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<float> some(-0.2F, 2);
    for (const int width : {2, 3, 64, 65, 66, 67, 131}) {
        Image<float> picture({width, 3});
        for (float& pixel : picture.pixels())
            pixel = some(random) < 0 ? std::nanf("") : some(random);
        for (int x = 1; x + 1 < width; x += static_cast<int>(kBlock)) {
            const auto from = [&](int y) {
                return std::as_const(picture).row(y).subspan(static_cast<std::size_t>(x) - 1);
            };
            BlockOfPixels light;
            findLight(from(0), from(1), from(2), light);
            for (std::size_t i = 0; i < kBlock; ++i) {
                const auto wanted = lightAround(picture, x + static_cast<int>(i), 1);
                EXPECT_EQ(light[i], wanted.value_or(0)) << width << ' ' << x << ' ' << i;
            }
        }
    }
}

TEST(ScaleSystem, WhatIsAddedToOneNodeIsSeenAsBrightness) {
    std::mt19937_64 random(7);
    const ScaleSystem system = threeNodes({1, 1, 1}, random);
    // 0.01 more at lights of 1 and 4, weighted by their squares: 0.01 (1 + 4) / (1 + 16).
    const Eigen::Vector3d third{0, 0, 1};
    EXPECT_NEAR(system.addedAlong(third, 0.01 * third), 0.01 * 5 / 17, 3e-4);
}

TEST(ScaleSystem, LightAroundIsTheNeighboursMean) {
    Image<float> picture({4, 3}, 2);
    picture.at(1, 1) = 100;
    EXPECT_EQ(lightAround(picture, 1, 1), 2);
    EXPECT_EQ(lightAround(picture, 2, 1), (100 + 2 + 2 + 2) / 4.0);
    picture.at(1, 1) = -100;
    EXPECT_EQ(lightAround(picture, 2, 1), 0);
    EXPECT_FALSE(lightAround(picture, 0, 1));
    EXPECT_FALSE(lightAround(picture, 2, 2));
    picture.at(1, 1) = std::nanf("");
    EXPECT_FALSE(lightAround(picture, 2, 1));
    EXPECT_TRUE(lightAround(picture, 1, 1));
    EXPECT_FALSE(lightAround(Image<float>({1, 1}, 1), 0, 0));
}

}  // namespace
}  // namespace gonio::proc
