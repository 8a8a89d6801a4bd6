#include "proc/estimate/answer_blend.h"

#include <cmath>

#include "tests/estimate/made_up.h"

namespace gonio::proc {
namespace {

Answer part(double f) { return answerOf(test::sampleAt(test::pairAt(0, 0), f)); }

TEST(AnswerBlend, AddsRandomInQuadratureAndSystematicWithItsSign) {
    AnswerBlend blend;
    blend.add(3, part(1));
    blend.add(-1, part(2));
    const Answer answer = blend.sum(Source::Interpolated);
    EXPECT_DOUBLE_EQ(answer.f[Band::R], 1);
    EXPECT_DOUBLE_EQ(answer.f[Band::B], 3);
    EXPECT_DOUBLE_EQ((*answer.uRandom)[Band::R], std::hypot(3 * 0.1, 0.2));
    EXPECT_DOUBLE_EQ((*answer.uSystematic)[Band::R], 3 * 0.05 - 0.1);
}

TEST(AnswerBlend, MeansOverTheWeights) {
    AnswerBlend blend;
    blend.add(1, part(1));
    blend.add(3, part(5));
    const Answer answer = blend.mean(Source::Interpolated);
    EXPECT_DOUBLE_EQ(answer.f[Band::G], 2 * 4);
    EXPECT_DOUBLE_EQ((*answer.uRandom)[Band::G], 2 * std::hypot(0.25 * 0.1, 0.75 * 0.5));
    EXPECT_DOUBLE_EQ((*answer.uSystematic)[Band::G], 2 * 0.05 * 4);
}

TEST(AnswerBlend, WeighsEachBandForItself) {
    AnswerBlend blend;
    blend.add(LedBands{{1, 0, 2}}, part(1));
    const Answer answer = blend.sum(Source::Extrapolated);
    EXPECT_EQ(answer.f, (LedBands{{1, 0, 6}}));
    EXPECT_EQ((*answer.uRandom)[Band::G], 0);
}

TEST(AnswerBlend, LeavesOutPartsOfNoWeight) {
    AnswerBlend blend;
    blend.add(1, part(1));
    blend.add(0, Answer::none({Flag::Saturated}, Source::Extrapolated));
    EXPECT_TRUE(blend.isOneMeasurement());
    const Answer answer = blend.mean(Source::Measured);
    EXPECT_EQ(answer.f, part(1).f);
    EXPECT_EQ(answer.flags, Flags{Flag::Measured});
}

TEST(AnswerBlend, KnowsAnUncertaintyOnlyWhereAllPartsDo) {
    Answer bare = part(1);
    bare.uSystematic.reset();
    AnswerBlend blend;
    blend.add(1, part(1));
    blend.add(1, bare);
    const Answer answer = blend.mean(Source::Interpolated);
    EXPECT_TRUE(answer.uRandom);
    EXPECT_FALSE(answer.uSystematic);
}

TEST(AnswerBlend, HasOneOriginAndKeepsOtherFlags) {
    Answer glare = part(1);
    glare.flags.set(Flag::GlareCorrected).set(Flag::Interpolated);
    AnswerBlend blend;
    blend.add(1, glare);
    blend.add(1, part(2));
    EXPECT_EQ(blend.mean(Source::Extrapolated).flags,
              (Flags{Flag::GlareCorrected, Flag::Extrapolated}));
    EXPECT_EQ(blend.mean(Source::Interpolated).flags,
              (Flags{Flag::GlareCorrected, Flag::Interpolated}));
    EXPECT_FALSE(blend.isOneMeasurement());
}

TEST(AnswerBlend, OfNothingIsNothing) {
    EXPECT_FALSE(AnswerBlend().mean(Source::Interpolated).present());
    EXPECT_FALSE(AnswerBlend().sum(Source::Interpolated).present());
    AnswerBlend blend;
    blend.add(1, Answer::none({Flag::Blocked}, Source::Measured));
    const Answer answer = blend.mean(Source::Interpolated);
    EXPECT_FALSE(answer.present());
    EXPECT_EQ(answer.flags, Flags{Flag::Blocked});
    EXPECT_FALSE(answer.uRandom);
}

}  // namespace
}  // namespace gonio::proc
