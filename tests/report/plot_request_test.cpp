#include "proc/report/plot_request.h"

#include <gtest/gtest.h>

#include "tests/report/pictures.h"

namespace gonio::proc {
namespace {

const test::Answering kColour([](const LightView&) { return test::same(1); });
const test::Answering kMono([](const LightView&) { return test::same(1); }, BandCount::One);

TEST(PlotRequest, ShowsEachBandThatDiffers) {
    EXPECT_EQ(shownBands(kColour).size(), 3U);
    ASSERT_EQ(shownBands(kMono).size(), 1U);
    EXPECT_EQ(bandLabel(kColour, Band::R), "R 630 nm");
    EXPECT_EQ(bandLabel(kColour, Band::B), "B 465 nm");
    EXPECT_EQ(bandLabel(kMono, Band::R), "monochrome");
}

TEST(PlotRequest, WritesAnglesToATenthOfADegree) {
    EXPECT_EQ(degreesLabel(0_deg), "0 deg");
    EXPECT_EQ(degreesLabel(22.5_deg), "22.5 deg");
    EXPECT_EQ(degreesLabel(59.96_deg), "60 deg");
    EXPECT_EQ(degreesLabel(-0.01_deg), "0 deg");  // never -0
}

}  // namespace
}  // namespace gonio::proc
