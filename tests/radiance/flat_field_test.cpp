#include "proc/radiance/flat_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace gonio::proc {
namespace {

constexpr Size kSize{120, 100};
constexpr double kNonUniformity = 0.01;

/// What each pixel answers, drawn once.
Image<float> truth() {
    std::mt19937_64 random(3);
    std::normal_distribution<double> draw(1, kNonUniformity);
    Image<float> response(kSize);
    for (float& one : response.pixels()) one = static_cast<float>(draw(random));
    return response;
}

/// Light that falls to a half over the picture, with noise, as these pixels see it.
MergedState picture(const Image<float>& response, std::uint64_t seed, double noise = 0.002) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> draw(1, noise);
    MergedState state{.radiance = Image<float>(kSize),
                      .variance = Image<float>(kSize),
                      .window = {.size = kSize}};
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
            const double light = 1e5 * (1 - 0.5 * x / kSize.width);
            state.radiance.at(x, y) = static_cast<float>(light * response.at(x, y) * draw(random));
            state.variance.at(x, y) = static_cast<float>(std::pow(noise * light, 2));
        }
    }
    return state;
}

std::vector<const MergedState*> pointers(const std::vector<MergedState>& states) {
    std::vector<const MergedState*> all;
    for (const MergedState& state : states) all.push_back(&state);
    return all;
}

TEST(FlatField, IsWhatThePixelsAnswerToSmoothLight) {
    const Image<float> response = truth();
    std::vector<MergedState> white;
    for (std::uint64_t i = 1; i <= 12; ++i) white.push_back(picture(response, i));
    const auto flat = flatField(pointers(white));
    ASSERT_TRUE(flat) << flat.error().message;
    EXPECT_NEAR(flat->spread, kNonUniformity, 0.1 * kNonUniformity);
    EXPECT_NEAR(flat->coveredPixels, 106.0 * 86 / (120 * 100), 1e-9);
    double squares = 0, count = 0;
    for (int y = 10; y < kSize.height - 10; ++y) {
        for (int x = 10; x < kSize.width - 10; ++x) {
            squares += std::pow(flat->response.at(x, y) - response.at(x, y), 2);
            count += 1;
        }
    }
    // The pictures' noise, and that of the 225 neighbours' own response.
    const double expected = std::hypot(flat->uResponse, kNonUniformity / 15);
    EXPECT_NEAR(std::sqrt(squares / count), expected, 0.1 * expected);
    EXPECT_NEAR(flat->uResponse, 0.002 * std::sqrt(M_PI / 2 / 12), 1e-4);

    MergedState seen = picture(response, 99, 1e-6);
    ASSERT_TRUE(flat->apply(seen));
    EXPECT_NEAR(seen.radiance.at(60, 50), 1e5 * 0.75, 4 * expected * 1e5);
    const double before = std::pow(1e-6 * 1e5 * 0.75, 2);
    EXPECT_NEAR(
        seen.variance.at(60, 50), before / std::pow(flat->response.at(60, 50), 2), 1e-5 * before);
}

TEST(FlatField, SaysNothingAtEdgesAndBesideMissingPixels) {
    MergedState state = picture(Image<float>(kSize, 1.0F), 1);
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < 40; ++x) state.radiance.at(x, y) *= 0.5F;  // a shadow
    }
    state.radiance.at(90, 50) = std::numeric_limits<float>::quiet_NaN();
    const std::vector<MergedState> one{state};
    const auto flat = flatField(pointers(one));
    ASSERT_TRUE(flat) << flat.error().message;
    for (const auto& [x, y] : {std::pair{3, 50}, {39, 50}, {42, 50}, {90, 50}, {96, 55}}) {
        EXPECT_EQ(flat->response.at(x, y), 1.0F) << x << " " << y;
    }
    EXPECT_NE(flat->response.at(70, 50), 1.0F);
}

TEST(FlatField, RefusesWhatIsNoWhite) {
    EXPECT_EQ(flatField({}).error().kind, ErrorKind::Quality);
    std::vector<MergedState> dark{picture(Image<float>(kSize, 1.0F), 1)};
    for (float& one : dark.front().radiance.pixels()) one = 0;
    const auto refused = flatField(pointers(dark));
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("white reference"), std::string::npos);
    dark.push_back(dark.front());
    dark.back().window.x = 8;
    EXPECT_FALSE(flatField(pointers(dark)));
    FlatField other{.response = Image<float>(kSize, 2.0F), .window = dark.back().window};
    EXPECT_FALSE(other.apply(dark.front())) << "of another window";
}

}  // namespace
}  // namespace gonio::proc
