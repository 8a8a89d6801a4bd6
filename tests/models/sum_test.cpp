#include "proc/models/sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

std::unique_ptr<const AnalyticModel> model(const std::string& spec) {
    return std::move(*makeModel(spec));
}

const LightView kPair{Direction::fromSpherical(20_deg, 0_deg), Direction()};

TEST(SumModel, IsTheSumOfItsPartsInEachBand) {
    const LedBands a{{0.1, 0.2, 0.3}};
    const LedBands b{{0.4, 0, 0.5}};
    const Answer answer =
        model("lambert,albedo=0.1/0.2/0.3+lambert,albedo=0.4/0/0.5")->answer(kPair);
    for (Band band : kBands) EXPECT_DOUBLE_EQ(answer.f[band], (a[band] + b[band]) / kPi);
    EXPECT_EQ(answer.source, Source::Analytic);
    EXPECT_EQ(answer.flags, Flags{});
}

TEST(SumModel, OfOnePartIsThatPart) {
    std::vector<std::unique_ptr<const AnalyticModel>> parts;
    parts.push_back(model("ggx,alpha=0.2,f0=0.5"));
    const LedBands alone = parts.front()->answer(kPair).f;
    EXPECT_EQ(Sum(std::move(parts)).answer(kPair).f, alone);
}

TEST(SumModel, AnswersNoneBelowTheHorizon) {
    const auto sum = model("lambert,albedo=0.1+ggx,alpha=0.2,f0=0.5");
    const Answer below = sum->answer({Direction(), *Direction::fromVector({1, 0, -0.1})});
    EXPECT_FALSE(below.present());
    EXPECT_EQ(below.flags, Flags{Flag::BelowHorizon});
}

}  // namespace
}  // namespace gonio::proc
