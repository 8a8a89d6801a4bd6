#include "proc/core/stopwatch.h"

#include <gtest/gtest.h>

namespace gonio {
namespace {

class SetClock : public Clock {
public:
    [[nodiscard]] Nanoseconds now() const override { return time; }
    Nanoseconds time{0};
};

TEST(Stopwatch, StandsWhileItsClockStands) {
    SetClock clock;
    clock.time = Nanoseconds(-5);  // the origin is arbitrary
    const Stopwatch watch(clock);
    EXPECT_EQ(watch.elapsed().count(), 0);
    EXPECT_EQ(watch.elapsed().count(), 0);
}

TEST(Stopwatch, KeepsNanosecondsOverAYear) {
    SetClock clock;
    const Stopwatch early(clock);
    clock.time = std::chrono::hours(24 * 365);
    const Stopwatch late(clock);
    clock.time += Nanoseconds(1);
    EXPECT_DOUBLE_EQ(late.elapsed().count(), 1e-9);
    EXPECT_DOUBLE_EQ(early.elapsed().count(), 365 * 86400.0);
}

}  // namespace
}  // namespace gonio
