#include "proc/report/neighbour_plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/report/xml.h"

namespace gonio::proc {
namespace {

std::vector<NeighbourCost> rows() {
    std::vector<NeighbourCost> all;
    for (const double n : {1e3, 1e4, 1e5}) {
        all.push_back({.samples = static_cast<std::size_t>(n),
                       .build = Seconds(1e-7 * n),
                       .query = Seconds(1e-6 * std::pow(n, 0.25)),
                       .bruteForce = Seconds(1e-8 * n),
                       .treeBytes = static_cast<std::size_t>(120 * n),
                       .sampleBytes = static_cast<std::size_t>(200 * n)});
    }
    return all;
}

TEST(NeighbourPlot, HasAMarkForEachCostAndSaysThePowers) {
    const std::string svg = neighbourPlot(rows());
    EXPECT_EQ(test::readXml(svg).fault, "") << svg;
    EXPECT_EQ(test::readXml(svg).all("circle").size(), 5U * 3U);
    EXPECT_NE(svg.find("query, tree: n^0.25"), std::string::npos);
    EXPECT_NE(svg.find("query, walk over all: n^1.00"), std::string::npos);
}

TEST(NeighbourPlot, LeavesOutWhatHasNoNumber) {
    auto some = rows();
    some[1].query = Seconds(0);
    const std::string svg = neighbourPlot(some);
    EXPECT_EQ(test::readXml(svg).fault, "");
    EXPECT_EQ(test::readXml(svg).all("circle").size(), 5U * 3U - 1U);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    EXPECT_EQ(test::readXml(neighbourPlot({rows().front()})).fault, "");
    EXPECT_EQ(test::readXml(neighbourPlot({})).fault, "");
}

}  // namespace
}  // namespace gonio::proc
