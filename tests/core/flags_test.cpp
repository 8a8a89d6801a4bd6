#include "proc/core/flags.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace gonio {
namespace {

// The names are those of JSON, in the order of the bits (DESIGN.md 3).
constexpr std::array<std::string_view, kFlagCount> kNames{"measured",
                                                          "saturated",
                                                          "below_noise",
                                                          "blocked",
                                                          "below_horizon",
                                                          "reciprocity",
                                                          "interpolated",
                                                          "prior",
                                                          "model",
                                                          "extrapolated",
                                                          "glare_corrected",
                                                          "tilt_corrected",
                                                          "drift_corrected",
                                                          "not_planned"};

TEST(FlagNames, StandInTheOrderOfTheBits) {
    for (int bit = 0; bit < kFlagCount; ++bit) {
        const auto flag = static_cast<Flag>(bit);
        EXPECT_EQ(name(flag), kNames[static_cast<std::size_t>(bit)]);
        EXPECT_EQ(Flags{flag}.mask(), 1U << static_cast<unsigned>(bit));
        EXPECT_EQ(describe({flag}), name(flag));
    }
}

TEST(FlagNames, AllFlagsAreDescribedInBitOrder) {
    std::string all;
    for (const std::string_view one : kNames) {
        if (!all.empty()) all += ',';
        all += one;
    }
    EXPECT_EQ(describe(Flags::fromMask((1U << kFlagCount) - 1)), all);
}

TEST(Flags, KeepBitsThatTheyDoNotKnow) {
    const Flags later = Flags::fromMask(1U << 20 | 1U);
    EXPECT_EQ(later.mask(), 1U << 20 | 1U);
    EXPECT_EQ(describe(later), "measured");
    EXPECT_EQ((later | Flags{Flag::Prior}).mask(), 1U << 20 | 1U << 7 | 1U);
}

TEST(SourceNames, AreSevenDifferentWords) {
    std::set<std::string_view> names;
    for (int i = 0; i <= static_cast<int>(Source::Analytic); ++i)
        names.insert(name(static_cast<Source>(i)));
    EXPECT_EQ(names.size(), 7U);
    EXPECT_TRUE(names.contains("measured") && names.contains("extrapolated"));
}

}  // namespace
}  // namespace gonio
