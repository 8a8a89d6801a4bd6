#include "proc/models/sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "proc/models/lambert.h"

namespace gonio::proc {
namespace {

/// Answers nothing, and says why.
class Silent : public Scatterer {
public:
    explicit Silent(Flag why) : why_(why) {}
    [[nodiscard]] Answer answer(const LightView&) const override {
        return Answer::none({why_}, Source::Measured);
    }

private:
    Flag why_;
};

template <class... Parts>
Sum sumOf(Parts... parts) {
    std::vector<std::unique_ptr<const Scatterer>> list;
    (list.push_back(std::make_unique<Parts>(std::move(parts))), ...);
    return Sum(std::move(list));
}

const LightView kPair{Direction::fromSpherical(20_deg, 0_deg), Direction()};

TEST(SumModel, IsTheSumOfItsPartsInEachBand) {
    const LedBands a{{0.1, 0.2, 0.3}};
    const LedBands b{{0.4, 0, 0.5}};
    const Answer answer = sumOf(Lambert(a), Lambert(b)).answer(kPair);
    for (Band band : kBands) EXPECT_DOUBLE_EQ(answer.f[band], (a[band] + b[band]) / kPi);
    EXPECT_EQ(answer.source, Source::Analytic);
    EXPECT_EQ(answer.flags, Flags{});
}

TEST(SumModel, OfOnePartIsThatPart) {
    const Lambert part(LedBands::all(0.5));
    EXPECT_EQ(sumOf(part).answer(kPair).f, part.answer(kPair).f);
}

TEST(SumModel, AnswersNoneWhereAnyPartDoesAndJoinsTheFlags) {
    const Lambert part(LedBands::all(0.5));
    EXPECT_TRUE(std::isnan(sumOf(part, Silent(Flag::Blocked)).answer(kPair).f[Band::R]));
    const Answer answer = sumOf(Silent(Flag::Blocked), part, Silent(Flag::Saturated)).answer(kPair);
    EXPECT_FALSE(answer.present());
    EXPECT_EQ(answer.flags, (Flags{Flag::Blocked, Flag::Saturated}));
}

}  // namespace
}  // namespace gonio::proc
