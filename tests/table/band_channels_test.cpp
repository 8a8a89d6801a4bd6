#include "proc/table/band_channels.h"

#include <gtest/gtest.h>

namespace gonio::proc {
namespace {

TEST(BandChannels, OneIsMonochrome) {
    const auto found = bandChannels(std::vector<Channel>{{"", 650.0}});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->count, BandCount::One);
    EXPECT_FALSE(found->resampled);
}

TEST(BandChannels, TakesBandsByNameInAnyOrder) {
    const auto found = bandChannels(std::vector<Channel>{{"B", {}}, {"G", {}}, {"R", {}}});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->bands[0].low, 2U);
    EXPECT_EQ(found->bands[2].low, 0U);
    EXPECT_FALSE(found->resampled);
}

TEST(BandChannels, BlendsTheWavelengthsAboutABand) {
    std::vector<Channel> channels;
    for (double nm = 450; nm <= 650; nm += 50) channels.push_back({"", nm});
    const auto found = bandChannels(channels);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->resampled);
    const double green = found->bands[1].of([&](std::size_t i) { return *channels[i].nanometres; });
    EXPECT_NEAR(green, 525, 1e-12);
    EXPECT_EQ(found->bands[1].low, 1U);
    EXPECT_EQ(found->bands[1].high, 2U);
}

TEST(BandChannels, ReachesNoFartherThan25Nanometres) {
    const std::vector<Channel> near{{"", 490.0}, {"", 525.0}, {"", 605.0}};
    EXPECT_TRUE(bandChannels(near));
    const std::vector<Channel> far{{"", 490.0}, {"", 525.0}, {"", 604.0}};
    ASSERT_FALSE(bandChannels(far));
    EXPECT_NE(bandChannels(far).error().message.find("--bands"), std::string::npos);
}

TEST(BandChannels, RefusesTristimulusValues) {
    const auto found = bandChannels(std::vector<Channel>{{"X", {}}, {"Y", {}}, {"Z", {}}});
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().kind, ErrorKind::Usage);
}

}  // namespace
}  // namespace gonio::proc
