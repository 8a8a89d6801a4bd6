#include "proc/plan/prediction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace gonio::proc {
namespace {

/// The same by sorting.
Spread sorted(std::vector<Counted> values) {
    std::ranges::sort(values, {}, &Counted::value);
    double all = 0;
    for (const Counted& v : values) all += v.count;
    const auto quantile = [&](double share) {
        double below = 0;
        for (const Counted& v : values) {
            below += v.count;
            if (below >= share * all) return v.value;
        }
        return values.back().value;
    };
    return {.worst = values.back().value, .percentile95 = quantile(0.95), .median = quantile(0.5)};
}

TEST(Prediction, ASpreadIsThatOfTheSortedValues) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> value(0, 1);
    for (std::size_t size = 1; size < 200; ++size) {
        std::vector<Counted> values;
        for (std::size_t i = 0; i < size; ++i) {
            const double drawn = std::round(50 * value(random)) / 50;  // some are alike
            values.push_back({.value = drawn, .count = 1 + static_cast<int>(4 * value(random))});
        }
        if (size % 10 == 0) values.front().value = std::numeric_limits<double>::infinity();
        const Spread wanted = sorted(values), found = spreadOf(values);
        ASSERT_EQ(found.worst, wanted.worst) << size;
        ASSERT_EQ(found.percentile95, wanted.percentile95) << size;
        ASSERT_EQ(found.median, wanted.median) << size;
    }
}

TEST(Prediction, NothingHasNoSpread) {
    EXPECT_TRUE(std::isnan(spreadOf({}).worst));
    EXPECT_TRUE(std::isnan(spreadOf({}).median));
}

}  // namespace
}  // namespace gonio::proc
