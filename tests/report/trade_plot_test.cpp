#include "proc/report/trade_plot.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/report/xml.h"

namespace gonio::proc {
namespace {

TradeRow rowOf(const std::string& rig, int levels, double seconds, double total) {
    TradeRow row{.rig = rig, .levels = levels, .material = "gloss & <metal>"};
    row.seconds.exposure = Seconds(seconds);
    row.predicted.random = {.worst = total / 2};
    row.predicted.systematic = {.worst = 0.0124};
    row.predicted.total = {.worst = total};
    row.cramerRao = Seconds(seconds / 2);
    return row;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

TEST(TradePlot, HasAPanelForEachRigAndAMarkForEachPlan) {
    const std::string svg = tradePlot(
        {rowOf("USB 2", 1, 300, 0.02), rowOf("USB 2", 3, 3, 0.016), rowOf("USB 3", 3, 1.7, 0.016)});
    EXPECT_EQ(test::readXml(svg).fault, "") << svg;
    EXPECT_EQ(count(svg, "<circle"), 3U);
    EXPECT_EQ(count(svg, "MiniDiff V2, 135 s"), 2U);
    EXPECT_EQ(count(svg, "systematic 1.24 %"), 2U);
    EXPECT_NE(svg.find("gloss &amp; &lt;metal&gt;, USB 3"), std::string::npos);
}

TEST(TradePlot, LeavesOutWhatHasNoNumber) {
    TradeRow none = rowOf("USB 2", 1, 3, 0.02);
    none.predicted = {.random = {std::numeric_limits<double>::quiet_NaN()},
                      .total = {std::numeric_limits<double>::quiet_NaN()}};
    const std::string svg = tradePlot({none, rowOf("USB 2", 3, 3, 0.016)});
    EXPECT_EQ(test::readXml(svg).fault, "");
    EXPECT_EQ(count(svg, "<circle"), 1U);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(test::readXml(tradePlot({})).fault, "");
}

}  // namespace
}  // namespace gonio::proc
