#include "proc/table/tensor_bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/random_directions.h"
#include "tests/support/tensor_tables.h"

namespace gonio::proc {
namespace {

using test::smallTensor;

TensorBsdf over(TensorTable table) {
    auto made = TensorBsdf::over(std::move(table));
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return std::move(*made);
}

Direction at(double theta, double phi) {
    return Direction::fromSpherical(Radians(theta), Radians(phi));
}

TEST(TensorTable, PutsDirectionsOnTheSquareAndBack) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 500; ++i) {
        const Direction d = test::randomDirection(random);
        const Direction back = directionOf(squareOf(d.theta(), d.phi()));
        ASSERT_LT((d.vector() - back.vector()).norm(), 1e-12);
    }
    EXPECT_EQ(squareOf(Radians(0), Radians(0)).x, 0);
    EXPECT_NEAR(squareOf(Radians(kPi / 2), Radians(-kPi / 2)).y, 0.25, 1e-15);
}

TEST(TensorBsdf, DividesTheCosineOut) {
    const TensorBsdf bsdf = over(smallTensor());
    // value ndf / (4 sigma) = value * 2.
    const Answer answer = bsdf.answer({at(0.75, 1), at(1.1, 2)});
    EXPECT_NEAR(answer.f[Band::R], 2 * 1.75 / std::cos(1.1), 1e-6);
    EXPECT_NEAR(answer.f[Band::B], 2 * 3.75 / std::cos(1.1), 1e-6);
    EXPECT_EQ(answer.source, Source::Interpolated);
}

TEST(TensorBsdf, TakesValuesAloneWithoutTheJacobian) {
    TensorTable table = smallTensor();
    table.jacobian = false;
    const Answer answer = over(table).answer({at(0.5, 1), at(1.1, 2)});
    EXPECT_NEAR(answer.f[Band::G], 2.5 / std::cos(1.1), 1e-6);
}

TEST(TensorBsdf, ExtrapolatesBeyondTheLastTheta) {
    const Answer answer = over(smallTensor()).answer({at(1.3, 1), at(0.3, 2)});
    EXPECT_TRUE(answer.flags.has(Flag::Extrapolated));
    EXPECT_NEAR(answer.f[Band::R], 2 * 2 / std::cos(0.3), 1e-6);
}

TEST(TensorBsdf, HasNoAnswerAtAndBelowTheHorizon) {
    const TensorBsdf bsdf = over(smallTensor());
    EXPECT_TRUE(bsdf.answer({at(0.3, 0), at(1.6, 0)}).flags.has(Flag::BelowHorizon));
    EXPECT_TRUE(bsdf.answer({at(1.6, 0), at(0.3, 0)}).flags.has(Flag::BelowHorizon));
    const Answer grazing = bsdf.answer({at(0.3, 0), at(kPi / 2 - 5e-5, 0)});
    EXPECT_FALSE(grazing.present());
    EXPECT_EQ(grazing.flags, Flags{});
}

TEST(TensorBsdf, AnswersZeroForANegativeValue) {
    TensorTable table = smallTensor();
    for (float& value : table.values.values) value -= 2.25F;
    const Answer answer = over(table).answer({at(0.5, 1), at(0.3, 2)});
    EXPECT_EQ(answer.f[Band::R], 0);
    EXPECT_GT(answer.f[Band::B], 0);
}

TEST(TensorBsdf, TurnsAnIsotropicTableWithTheLight) {
    TensorTable table = smallTensor();
    std::mt19937_64 random(2);
    std::uniform_real_distribution<float> any(0, 1);
    table.values = {.width = 5, .height = 5, .values = {}};
    for (int i = 0; i < 9 * 25; ++i) table.values.values.push_back(any(random));
    const TensorBsdf bsdf = over(table);
    for (int i = 0; i < 100; ++i) {
        const Direction wi = test::randomDirection(random);
        const Direction wo = test::randomDirection(random);
        const double f = bsdf.answer({wi, wo}).f[Band::R];
        const double turned = bsdf.answer({wi.turned(2_deg), wo.turned(2_deg)}).f[Band::R];
        ASSERT_NEAR(turned, f, 1e-6 * (1 + f));
    }
}

TEST(TensorBsdf, TakesHalfACircleForTheSameTurnedBy180Degrees) {
    TensorTable table = smallTensor();
    const auto pi = static_cast<float>(kPi);
    table.thetaIn = {0};
    table.phiIn = {-pi, -pi / 2, 0};
    for (int i = 0; i < 36; ++i)
        table.values.values[static_cast<std::size_t>(i)] = static_cast<float>(i / 12);
    EXPECT_EQ(table.reduction(), 2);
    const TensorBsdf bsdf = over(table);
    for (const double phi : {-2.0, -1.0, -0.3}) {
        const double f = bsdf.answer({at(0.3, phi), at(0.2, 0.1)}).f[Band::R];
        EXPECT_NEAR(bsdf.answer({at(0.3, phi + kPi), at(0.2, 0.1 + kPi)}).f[Band::R], f, 1e-6);
    }
}

TEST(TensorBsdf, TakesAQuarterForTheSameMirrored) {
    TensorTable table = smallTensor();
    const auto pi = static_cast<float>(kPi);
    table.thetaIn = {0};
    table.phiIn = {-pi, -0.75F * pi, -0.5F * pi};
    for (int i = 0; i < 36; ++i)
        table.values.values[static_cast<std::size_t>(i)] = static_cast<float>(i / 12);
    EXPECT_EQ(table.reduction(), 4);
    const TensorBsdf bsdf = over(table);
    const double f = bsdf.answer({at(0.3, -2.5), at(0.2, 0.1)}).f[Band::R];
    EXPECT_NEAR(bsdf.answer({at(0.3, 2.5), at(0.2, -0.1)}).f[Band::R], f, 1e-6);
    EXPECT_NEAR(bsdf.answer({at(0.3, kPi + 2.5), at(0.2, kPi - 0.1)}).f[Band::R], f, 1e-6);
    EXPECT_NEAR(bsdf.answer({at(0.3, kPi - 2.5), at(0.2, kPi + 0.1)}).f[Band::R], f, 1e-6);
}

TEST(TensorBsdf, RefusesTablesThatDoNotFitTogether) {
    const auto refused = [](auto change) {
        TensorTable table = smallTensor();
        change(table);
        return !TensorBsdf::over(table);
    };
    EXPECT_FALSE(refused([](TensorTable&) {}));
    EXPECT_TRUE(refused([](TensorTable& t) { t.thetaIn = {0, 1, 1}; }));
    EXPECT_TRUE(refused([](TensorTable& t) { t.thetaIn = {}; }));
    EXPECT_TRUE(refused([](TensorTable& t) { t.phiIn = {0, 0.1F, 0.2F}; }));
    EXPECT_TRUE(refused([](TensorTable& t) { t.vndf.values.pop_back(); }));
    EXPECT_TRUE(refused([](TensorTable& t) { t.vndf.values.assign(18, 0.0F); }));
    EXPECT_TRUE(refused([](TensorTable& t) { t.ndf.width = 0; }));
    EXPECT_TRUE(refused([](TensorTable& t) { t.channels.pop_back(); }));
    EXPECT_TRUE(refused([](TensorTable& t) { t.channels = {}; }));
    EXPECT_TRUE(refused([](TensorTable& t) { t.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}}; }));
}

}  // namespace
}  // namespace gonio::proc
