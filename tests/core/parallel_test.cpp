#include "proc/core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <vector>

namespace gonio {
namespace {

TEST(ParallelFor, RangesAreDisjointNotEmptyAndCoverAll) {
    for (std::size_t count : {1UL, 2UL, 3UL, 7UL, 1000UL, 12345UL}) {
        std::mutex mutex;
        std::vector<IndexRange> ranges;
        parallelFor(count, [&](IndexRange range) {
            const std::lock_guard lock(mutex);
            ranges.push_back(range);
        });
        std::sort(ranges.begin(), ranges.end(), [](const IndexRange& a, const IndexRange& b) {
            return a.begin < b.begin;
        });
        std::size_t next = 0;
        for (const IndexRange& range : ranges) {
            EXPECT_EQ(range.begin, next);
            EXPECT_LT(range.begin, range.end);
            next = range.end;
        }
        EXPECT_EQ(next, count);
    }
}

TEST(ParallelFor, CallsNothingForNothing) {
    bool called = false;
    parallelFor(0, [&](IndexRange) { called = true; });
    EXPECT_FALSE(called);
}

TEST(ParallelFor, MayBeNestedAndAllIsDoneOnReturn) {
    std::vector<std::vector<int>> table(5, std::vector<int>(301, 0));
    parallelFor(table.size(), [&](IndexRange rows) {
        for (std::size_t row = rows.begin; row < rows.end; ++row) {
            parallelFor(table[row].size(), [&](IndexRange columns) {
                for (std::size_t c = columns.begin; c < columns.end; ++c)
                    table[row][c] += static_cast<int>(row * 1000 + c);
            });
        }
    });
    for (std::size_t row = 0; row < table.size(); ++row) {
        for (std::size_t c = 0; c < table[row].size(); ++c)
            ASSERT_EQ(table[row][c], static_cast<int>(row * 1000 + c));
    }
}

}  // namespace
}  // namespace gonio
