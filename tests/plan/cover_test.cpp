// The cheapest cover against trying everything, and its laws.

#include "proc/plan/cover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/plan/cover_bound.h"

namespace {

using namespace gonio;
using namespace gonio::proc;

struct Draw {
    std::mt19937_64 random;
    double logUniform(double low, double high) {
        return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random));
    }
    int upTo(int most) { return std::uniform_int_distribution(0, most)(random); }
};

/// Shots of one sensor; times and costs at random, some with frames at hand.
CoverProblem randomProblem(Draw& draw, std::size_t shots, std::size_t needs, int maxFrames) {
    CoverProblem problem{.shots = {}, .needs = {}, .maxFrames = maxFrames};
    for (std::size_t g = 0; g < shots; ++g) {
        const double tau = draw.logUniform(1e-6, 1e-2);
        const Nanoseconds frame(10'000'000 + 1'000'000 * draw.upTo(40));
        problem.shots.push_back({.option = {.kind = {},
                                            .tau = tau,
                                            .noise = draw.logUniform(1, 100),
                                            .darkVariance = draw.logUniform(0.1, 10),
                                            .reach = 9000 / tau},
                                 .have = draw.upTo(1),
                                 .frame = frame,
                                 .lastFrame = frame + Nanoseconds(1'000'000 * draw.upTo(8))});
    }
    for (std::size_t j = 0; j < needs; ++j) {
        const double rate = draw.logUniform(1e4, 1e8);
        const double sigma = draw.logUniform(0.01, 0.2) * rate;
        problem.needs.push_back({.rate = rate, .information = 1 / (sigma * sigma)});
    }
    return problem;
}

TEST(Cover, MatchesReference) {
    constexpr std::uint64_t kSeed = 20240611;
    Draw draw{std::mt19937_64(kSeed)};
    int answered = 0;
    for (int trial = 0; trial < 300; ++trial) {
        SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
        const CoverProblem problem = randomProblem(draw, 4, 5, 4);
        const auto fast = cheapestCover(problem).cover;
        const auto slow = cheapestCoverReference(problem);
        ASSERT_EQ(fast.has_value(), slow.has_value());
        if (!slow) continue;
        ++answered;
        EXPECT_EQ(fast->cost, slow->cost);
    }
    EXPECT_GT(answered, 50);
}

TEST(Cover, IsFoundUnderALimitThatOnlyItMeets) {
    // All but the best is cut off, and with it no way that leads there: what the frames tell is
    // rounded down, so that one frame more may tell nothing, and the next one all.
    constexpr std::uint64_t kSeed = 20240611;
    Draw draw{std::mt19937_64(kSeed)};
    int answered = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
        const CoverProblem problem = randomProblem(draw, 2, 2, 30);
        const auto slow = cheapestCoverReference(problem);
        if (!slow) continue;
        ++answered;
        const auto fast = cheapestCover(problem, slow->cost + Nanoseconds(1)).cover;
        ASSERT_TRUE(fast);
        EXPECT_EQ(fast->cost, slow->cost);
    }
    EXPECT_GT(answered, 300);
}

TEST(Cover, BoundIsNoMoreThanTheAnswer) {
    constexpr std::uint64_t kSeed = 7;
    Draw draw{std::mt19937_64(kSeed)};
    for (int trial = 0; trial < 200; ++trial) {
        SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
        const CoverProblem problem = randomProblem(draw, 6, 8, 40);
        const CoverBound bound = coverBound(problem);
        const CoverAnswer answer = cheapestCover(problem);
        if (!answer.cover) continue;
        EXPECT_LE(bound.seconds, Seconds(answer.cover->cost).count() + 1e-9);
        for (const double price : bound.prices) EXPECT_GE(price, 0);
    }
}

TEST(Cover, EssentialNeedsImplyTheRest) {
    constexpr std::uint64_t kSeed = 8;
    Draw draw{std::mt19937_64(kSeed)};
    for (int trial = 0; trial < 100; ++trial) {
        SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
        CoverProblem problem = randomProblem(draw, 3, 12, 5);
        const auto all = cheapestCoverReference(problem);
        problem.needs = essentialNeeds(problem.shots, problem.needs);
        EXPECT_LT(problem.needs.size(), 12U);
        const auto essential = cheapestCoverReference(problem);
        ASSERT_EQ(all.has_value(), essential.has_value());
        if (!all) continue;
        EXPECT_EQ(all->cost, essential->cost);
    }
}

TEST(Cover, LimitExcludesWhatCostsAsMuch) {
    constexpr std::uint64_t kSeed = 9;
    Draw draw{std::mt19937_64(kSeed)};
    int tried = 0;
    for (int trial = 0; trial < 50; ++trial) {
        const CoverProblem problem = randomProblem(draw, 4, 5, 20);
        const CoverAnswer answer = cheapestCover(problem);
        if (!answer.cover || answer.cover->cost == Nanoseconds(0)) continue;
        ++tried;
        EXPECT_FALSE(cheapestCover(problem, answer.cover->cost).cover) << kSeed << " " << trial;
        const auto again = cheapestCover(problem, answer.cover->cost + Nanoseconds(1));
        ASSERT_TRUE(again.cover) << kSeed << " " << trial;
        EXPECT_EQ(again.cover->cost, answer.cover->cost);
    }
    EXPECT_GT(tried, 10);
}

TEST(Cover, WithoutNeedsThereAreNoFrames) {
    Draw draw{std::mt19937_64(1)};
    const CoverAnswer answer = cheapestCover(randomProblem(draw, 4, 0, 4));
    ASSERT_TRUE(answer.cover);
    EXPECT_EQ(answer.cover->cost, Nanoseconds(0));
}

}  // namespace
