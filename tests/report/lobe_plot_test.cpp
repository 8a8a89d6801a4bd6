#include "proc/report/lobe_plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/report/xml.h"

namespace gonio::proc {
namespace {

std::size_t count(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++found;
    }
    return found;
}

TEST(LobePlot, DrawsEachCurveAndItsName) {
    const std::vector<LobeCurve> curves{{"truth", {-10, 0, 10}, {1, 10, 100}},
                                        {"ours & theirs", {-10, 0, 10}, {1, 11, 90}}};
    const std::string svg = lobePlot("A <lobe>", curves);
    EXPECT_EQ(test::readXml(svg).fault, "");
    // Each once as a curve and once beside its name.
    EXPECT_EQ(count(svg, "\"#aaa\""), 2U);
    EXPECT_EQ(count(svg, "\"#c0392b\""), 2U);
    EXPECT_NE(svg.find("ours &amp; theirs"), std::string::npos);
}

TEST(LobePlot, LeavesAGapWhereThereIsNoAnswer) {
    const double nan = std::nan("");
    const std::string svg = lobePlot("x", {{"t", {0, 1, 2, 3, 4}, {1, 2, nan, 3, 4}}});
    EXPECT_EQ(count(svg, "\"#aaa\""), 3U);
}

TEST(LobePlot, IsAHeadingAloneWithoutValues) {
    EXPECT_EQ(test::readXml(lobePlot("x", {})).fault, "");
    EXPECT_EQ(count(lobePlot("x", {{"t", {0, 1}, {0, std::nan("")}}}), "<polyline"), 0U);
}

}  // namespace
}  // namespace gonio::proc
