// A line through looks at a clock, and what it is worth; on a rig, see doctor_rig_test.cpp.

#include "daemon/clock_drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace gonio::daemon {
namespace {

constexpr double kMs = 1e-3, kPpm = 1e-6;

/// `n` looks, one a second, of a clock that was started 11 days after the host's.
std::vector<ClockLook> looks(int n, const std::function<double(double)>& offset) {
    std::vector<ClockLook> all;
    for (int i = 0; i < n; ++i) {
        all.push_back(
            {.host = 1e6 + i, .offset = -1e6 + offset(i), .uncertainty = 1e-5, .roundTrip = 2e-3});
    }
    return all;
}

TEST(ClockDrift, OfTwoLooksIsTheirDifferenceWithTheScatterInsideThem) {
    auto two = looks(2, [](double t) { return 50 * kPpm * t; });
    two[1].uncertainty = 3e-5;
    two[1].roundTrip = 1e-3;
    const ClockDrift drift = driftOf(two);
    // A time of 1e6 s has steps of 1.2e-10 s.
    EXPECT_NEAR(drift.relative, 50 * kPpm, 1e-9);
    EXPECT_NEAR(drift.uncertainty, 2 * std::hypot(1e-5, 3e-5), 1e-12);
    EXPECT_EQ(drift.passed, 1);
    EXPECT_EQ(drift.roundTrip, 2e-3);
}

TEST(ClockDrift, OfAStraightLineIsToldAsWellAsTheScatterInsideTheLooksTells) {
    const ClockDrift drift = driftOf(looks(6, [](double t) { return -2000 * kPpm * t; }));
    EXPECT_NEAR(drift.relative, -2000 * kPpm, 1e-9);
    EXPECT_NEAR(drift.uncertainty, 2 * 1e-5 / std::sqrt(17.5), 1e-9);  // 17.5 s2 about the middle
    EXPECT_TRUE(drift.beyondCrystals());
}

// A load that begins between any two looks shifts all offsets behind it: half a round trip of 2 ms
// at most, which is less than half of what it takes.
TEST(ClockDrift, ShiftBetweenAnyTwoLooksIsNoDrift) {
    for (int at = 1; at < 6; ++at) {
        for (const double shift : {-1 * kMs, -0.8 * kMs, 0.8 * kMs, 1 * kMs}) {
            const auto stepped = looks(6, [&](double t) { return t < at ? 0 : shift; });
            const ClockDrift drift = driftOf(stepped);
            EXPECT_FALSE(drift.beyondCrystals())
                << "before look " << at << ": " << drift.relative << " +- " << drift.uncertainty;
            const ClockDrift two = driftOf(std::span(stepped).subspan(std::size_t(at) - 1, 2));
            EXPECT_TRUE(two.beyondCrystals());  // what it would be without the others
        }
    }
}

// A computer gets so busy that an answer takes 11 ms longer, all of it on the way back.
TEST(ClockDrift, LargeShiftIsNoDriftWhereTheRoundTripsTellOfIt) {
    for (int at = 1; at < 6; ++at) {
        auto busy = looks(6, [&](double t) { return t < at ? 0 : -5.5 * kMs; });
        if (at == 3) {
            EXPECT_TRUE(driftOf(busy).beyondCrystals());  // by the residuals alone
        }
        for (int i = 0; i < 6; ++i) {
            busy[static_cast<std::size_t>(i)].furthest = (i < at ? 0.5 : 6) * kMs;
        }
        const ClockDrift drift = driftOf(busy);
        EXPECT_FALSE(drift.beyondCrystals()) << at << ": " << drift.relative;
    }
}

// 95 % of intervals hold the truth; of 4000 that share strays by 0.34 %, and four times that is
// never seen. Every look is off by as much as its load will have it.
TEST(ClockDrift, UncertaintyHoldsTheTruthInNineteenCasesOfTwenty) {
    constexpr int kCases = 4000;
    std::mt19937_64 random{7};
    std::normal_distribution<double> load(0, 0.3 * kMs);
    for (int n = 3; n <= 6; ++n) {
        int held = 0;
        for (int i = 0; i < kCases; ++i) {
            const ClockDrift drift =
                driftOf(looks(n, [&](double t) { return 500 * kPpm * t + load(random); }));
            if (std::abs(drift.relative - 500 * kPpm) <= drift.uncertainty) ++held;
        }
        EXPECT_NEAR(static_cast<double>(held) / kCases, 0.95, 4 * 0.0034) << n << " looks";
    }
}

TEST(ClockDrift, UncertaintyOfMoreThanSixLooksIsTooWideNotTooNarrow) {
    std::mt19937_64 random{8};
    std::normal_distribution<double> load(0, 0.3 * kMs);
    int held = 0;
    for (int i = 0; i < 1000; ++i) {
        const ClockDrift drift = driftOf(looks(12, [&](double) { return load(random); }));
        if (std::abs(drift.relative) <= drift.uncertainty) ++held;
    }
    EXPECT_GT(held, 955);  // 980 by Student's t of 10 degrees of freedom
}

}  // namespace
}  // namespace gonio::daemon
