#include "proc/core/scatterer.h"

#include <gtest/gtest.h>

#include <limits>

namespace gonio {
namespace {

TEST(Answer, IsPresentOnlyWithAllBands) {
    for (Band missing : kBands) {
        Answer answer;
        answer.f = LedBands::all(0.1);
        EXPECT_TRUE(answer.present());
        answer.f[missing] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_FALSE(answer.present());
    }
}

TEST(Answer, NoneSaysWhyAndWhence) {
    const Answer none = Answer::none({Flag::Blocked, Flag::Saturated}, Source::Measured);
    EXPECT_EQ(none.flags, (Flags{Flag::Blocked, Flag::Saturated}));
    EXPECT_EQ(none.source, Source::Measured);
    EXPECT_FALSE(none.uRandom || none.uSystematic);
}

class Plain : public Scatterer {
public:
    [[nodiscard]] Answer answer(const LightView&) const override { return {}; }
};

TEST(Scatterer, HasThreeBandsUnlessItSaysOtherwise) {
    EXPECT_EQ(Plain().bandCount(), BandCount::Three);
}

}  // namespace
}  // namespace gonio
