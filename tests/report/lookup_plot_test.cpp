#include "proc/report/lookup_plot.h"

#include <cmath>
#include <limits>

#include "tests/report/pictures.h"

namespace gonio::proc {
namespace {

LookupRow row(const std::string& method, const std::string& storage, int size) {
    LookupRow made;
    made.material = "paint <&>";
    made.method = method;
    made.storage = storage;
    made.resolution = std::to_string(8 * size) + "x8x4";
    made.bytes = static_cast<std::size_t>(size) * 4096;
    made.cosine.worst = 0.05 / size;
    made.scalarNs = 40;
    made.batchNs = method.starts_with("MERL") ? std::numeric_limits<double>::quiet_NaN() : 5;
    return made;
}

std::vector<LookupRow> study() {
    std::vector<LookupRow> rows;
    for (int size : {1, 4, 16}) {
        for (const char* storage : {"float", "half"}) rows.push_back(row("baked", storage, size));
    }
    rows.push_back(row("MERL nearest", "double", 100));
    markFront(rows);
    return rows;
}

/// Corners of the marks, by how many they have: 17, 5 and 4 points that end where they begin.
std::size_t marksOf(const test::Xml& xml, std::size_t points) {
    std::size_t count = 0;
    for (const test::XmlElement& line : xml.all("polyline")) {
        const auto all = test::pointsOf(line);
        const bool closed = all.size() > 2 && all.front().x == all.back().x;
        count += closed && all.size() == points ? 1U : 0U;
    }
    return count;
}

TEST(LookupPlot, HasAMarkForEachResolutionAndStorageAndRingsTheKnee) {
    const auto rows = study();
    const test::Xml xml = test::readPicture(lookupPlot(rows));
    // Twice each, against time and against bytes, and once in the legend.
    EXPECT_EQ(marksOf(xml, 17), 2U * 3 + 1);
    EXPECT_EQ(marksOf(xml, 5), 2U * 3 + 1);
    EXPECT_EQ(marksOf(xml, 4), 2U * 1 + 1);
    EXPECT_EQ(xml.all("circle").size(), 2U) << "the knee, in both panels";
    std::size_t front = 0;
    for (const LookupRow& one : rows) front += one.onFront ? 1 : 0;
    EXPECT_EQ(xml.all("polygon").size(), 2 * front);
    EXPECT_NE(lookupPlot(rows).find("paint &lt;&amp;&gt;"), std::string::npos);
    EXPECT_NE(lookupPlot(rows).find("128x8x4"), std::string::npos) << "the finest table's nodes";
}

TEST(LookupPlot, LeavesOutWhatHasNoNumber) {
    auto rows = study();
    rows[0].cosine.worst = 0;
    rows[1].cosine.worst = std::numeric_limits<double>::infinity();
    const test::Xml xml = test::readPicture(lookupPlot(rows));
    EXPECT_EQ(marksOf(xml, 17), 2U * 2 + 1);
    EXPECT_EQ(marksOf(xml, 5), 2U * 2 + 1);
    EXPECT_EQ(test::readPicture(lookupPlot({})).all("text").size(), 1U);
    test::readPicture(lookupPlot({rows[0]}));
}

}  // namespace
}  // namespace gonio::proc
