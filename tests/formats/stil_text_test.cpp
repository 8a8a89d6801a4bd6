#include "proc/formats/stil_text.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/formats/file_bytes.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/data_file.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;

/// One scan of 3 thetas x 2 phis; the rows are lines 10..12.
std::string small(const std::string& end = "\r") {
    std::string text;
    for (const char* line : {"Name / Comment :\tplate\t",
                             "Data file type :\tBRDF\t",
                             "Theta measure beginning :\t-30\t",
                             "Theta measure end :\t30\t",
                             "Theta measure step :\t30\t",
                             "Phi measure beginning :\t-90\t",
                             "Phi measure end :\t-80\t",
                             "Phi measure step :\t10\t",
                             "Theta Lighting\t20\t",
                             "-30\t1\t2",
                             "0\t3\t4",
                             "30\t5\t6",
                             "\t\t"}) {
        text += line + end;
    }
    return text;
}

FileRead<SphericalTable> parsed(std::string_view text) {
    auto read = parseStilText(text, "in.txt");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(*read) : FileRead<SphericalTable>{.content = {}, .about = {}};
}

double valueAt(const SphericalTable& table, std::size_t block, double azimuth, double theta) {
    const SphericalBlock& b = table.blocks.at(block);
    for (std::size_t a = 0; a < b.azimuthDeg.size(); ++a) {
        for (std::size_t t = 0; t < b.thetaDeg.size(); ++t) {
            if (b.azimuthDeg[a] == azimuth && b.thetaDeg[t] == theta) return b.f[b.index(a, t)];
        }
    }
    return std::nan("");
}

TEST(StilText, PutsNegativeThetasBeyondTheNormal) {
    const auto read = parsed(small());
    const SphericalTable& table = read.content;
    ASSERT_EQ(table.blocks.size(), 1U);
    EXPECT_EQ(table.blocks[0].incidenceDeg, 20);
    EXPECT_EQ(table.blocks[0].azimuthDeg, (std::vector<double>{90, 100, 270, 280}));
    EXPECT_EQ(table.blocks[0].thetaDeg, (std::vector<double>{0, 30}));
    EXPECT_EQ(valueAt(table, 0, 90, 30), 1);
    EXPECT_EQ(valueAt(table, 0, 100, 30), 2);
    EXPECT_EQ(valueAt(table, 0, 270, 30), 5);
    EXPECT_EQ(valueAt(table, 0, 280, 30), 6);
    for (const double azimuth : {90, 100, 270, 280}) {
        EXPECT_EQ(valueAt(table, 0, azimuth, 0), 3.5);  // the same direction
    }
    EXPECT_EQ(read.about.at(key::kSample), "plate");
    ASSERT_EQ(read.warnings.size(), 2U);
    EXPECT_TRUE(read.warnings[0].starts_with("1 directions were scanned more than once"));
    EXPECT_NE(read.warnings[1].find("mirror direction is taken at phi 270"), std::string::npos);
}

TEST(StilText, TakesTheMeanOfADirectionThatIsScannedTwice) {
    const std::string turned = replaced(replaced(small(), "end :\t-80", "end :\t90"),
                                        "Phi measure step :\t10",
                                        "Phi measure step :\t180");
    const auto read = parsed(turned);
    const SphericalTable& table = read.content;
    EXPECT_EQ(table.blocks[0].azimuthDeg, (std::vector<double>{90, 270}));
    EXPECT_EQ(valueAt(table, 0, 90, 30), 3.5);   // (-30, -90) 1, (30, 90) 6
    EXPECT_EQ(valueAt(table, 0, 270, 30), 3.5);  // (30, -90) 5, (-30, 90) 2
    EXPECT_TRUE(read.warnings[0].starts_with("3 directions"));
    const auto noSignal = parsed(replaced(turned, "30\t5\t6", "30\t5\t0"));
    EXPECT_EQ(valueAt(noSignal.content, 0, 90, 30), 1);
    const auto same = parsed(replaced(replaced(turned, "30\t5\t6", "30\t2\t1"), "3\t4", "3\t3"));
    EXPECT_EQ(valueAt(same.content, 0, 270, 30), 2);
    EXPECT_EQ(same.warnings.size(), 1U);
}

TEST(StilText, TakesAnyLineEnd) {
    for (const char* end : {"\r", "\n", "\r\n"}) {
        EXPECT_EQ(parsed(small(end)).content.blocks[0].f, parsed(small()).content.blocks[0].f);
        EXPECT_TRUE(refuses(parseStilText(replaced(small(end), "3\t4", "3\tx"), "in"),
                            {"stil: in: line 11: 'x' is not a finite number"}));
    }
    EXPECT_EQ(parsed("\xEF\xBB\xBF" + small()).content.blocks.size(), 1U);
}

TEST(StilText, NeverTakesZerosAndNegativesSilently) {
    const auto read = parsed(replaced(replaced(small(), "3\t4", "0\t-4"), "1\t2", "-1\t0"));
    ASSERT_EQ(read.warnings.size(), 4U);
    EXPECT_EQ(read.warnings[0], "2 values of exactly 0: no signal, not black");
    EXPECT_EQ(read.warnings[2], "5 negative values");  // theta 0 stands at four azimuths
}

TEST(StilText, MakesAChannelOfEachScanOfAnIncidence) {
    const auto read = parsed(small() + replaced(small(), "5\t6", "7\t8"));
    ASSERT_EQ(read.content.channels.size(), 2U);
    EXPECT_EQ(read.content.channels[1].name, "scan 2");
    EXPECT_EQ(valueAt(read.content, 0, 270, 30), 5);
    EXPECT_EQ(valueAt(read.content, 1, 270, 30), 7);
    EXPECT_NE(read.warnings[0].find("scanned 2 times"), std::string::npos);
    const auto other = parsed(small() + replaced(small(), "Lighting\t20", "Lighting\t40"));
    EXPECT_EQ(other.content.channels, std::vector<Channel>{Channel{}});
}

TEST(StilText, RefusesWhatDoesNotFitItsHeader) {
    EXPECT_TRUE(refuses(parseStilText("", "in"), {"no scan"}));
    EXPECT_TRUE(refuses(parseStilText(replaced(small(), "0\t3\t4\r", ""), "in"),
                        {"line 11", "theta '30', wanted 0"}));
    EXPECT_TRUE(refuses(parseStilText(replaced(small(), "30\t5\t6\r", ""), "in"),
                        {"2 rows, header promised 3"}));
    EXPECT_TRUE(refuses(parseStilText(replaced(small(), "3\t4", "3"), "in"),
                        {"line 11", "1 values in row, header promised 2"}));
    EXPECT_TRUE(
        refuses(parseStilText(replaced(small(), "3\t4", "3\t4\t5"), "in"), {"3 values in row"}));
    EXPECT_TRUE(
        refuses(parseStilText(replaced(small(), "30\t5\t6\r", "30\t5\t6\r60\t1\t1\r"), "in"),
                {"line 13", "more than 3 rows"}));
    EXPECT_TRUE(refuses(parseStilText(small() + "junk\t\r", "in"), {"ends within a header"}));
    EXPECT_TRUE(refuses(parseStilText(replaced(small(), "BRDF", "Luminance"), "in"),
                        {"line 2", "'Luminance'"}));
    EXPECT_TRUE(refuses(parseStilText(replaced(small(), "Lighting\t20", "Lighting\t90"), "in"),
                        {"[0, 90)"}));
    EXPECT_TRUE(
        refuses(parseStilText(replaced(small(), "end :\t30", "end :\t120"), "in"), {"beyond 90"}));
    EXPECT_TRUE(
        refuses(parseStilText(replaced(small(), "Phi measure end", "Theta measure end"), "in"),
                {"given twice"}));
    EXPECT_TRUE(refuses(parseStilText(replaced(small(), "Phi measure step :\t10\t\r", ""), "in"),
                        {"make no range"}));
}

TEST(StilText, RefusesRangesThatTheTextCannotHold) {
    for (const char* step : {"1e-6", "1e-300", "-30", "0", "7", "nan", "1,5"}) {
        const auto read = parseStilText(
            replaced(
                small(), "Theta measure step :\t30", std::string("Theta measure step :\t") + step),
            "in");
        EXPECT_TRUE(refuses(read, {"stil: in: line "})) << step;
    }
}

TEST(StilText, ReadsAHundredThousandPhisInNoTime) {
    std::string text = replaced(small(), "end :\t-80", "end :\t270");
    text = replaced(text, "Phi measure step :\t10", "Phi measure step :\t0.0036");
    text = replaced(text, "beginning :\t-30", "beginning :\t0");
    text = replaced(text, "Theta measure end :\t30", "Theta measure end :\t0");
    std::string row = "0";
    for (int i = 0; i <= 100'000; ++i) row += "\t1";
    text = text.substr(0, text.find("-30\t1\t2")) + row + "\r";
    EXPECT_EQ(parsed(text).content.blocks[0].azimuthDeg.size(), 100'000U);
}

TEST(StilText, RefusesATextCutAnywhereBeforeItsLastRow) {
    const std::string text = small();
    const std::size_t last = text.find("30\t5\t6") + std::string_view("30\t5\t").size();
    for (std::size_t size = 0; size <= last; ++size) {
        EXPECT_TRUE(refuses(parseStilText(text.substr(0, size), "cut"), {"stil: cut: line "}))
            << size;
    }
}

TEST(StilText, ReadsTheVendorsExport) {
    const auto file = test::dataFile("vendor_exports/test_lighttools.txt");
    if (!file) return;
    const auto bytes = readFile(*file);
    ASSERT_TRUE(bytes);
    const auto read = parsed(*bytes);
    const SphericalTable& table = read.content;
    ASSERT_EQ(table.blocks.size(), 4U);  // two runs of incidences 0 and 60
    EXPECT_EQ(table.channels.size(), 2U);
    EXPECT_EQ(table.blocks[1].incidenceDeg, 60);
    EXPECT_EQ(table.blocks[2].incidenceDeg, 0);
    EXPECT_EQ(valueAt(table, 2, 270, 30), -48523.83);
    EXPECT_EQ(valueAt(table, 2, 100, 30), -34382.23);
    EXPECT_EQ(valueAt(table, 3, 280, 30), -42487.36);
    EXPECT_EQ(valueAt(table, 3, 90, 30), -33840.56);
    EXPECT_EQ(valueAt(table, 0, 90, 30), 0);
    EXPECT_EQ(read.about.at(key::kSample), "OJN / ART-90-050B-87106_long");
    ASSERT_EQ(read.warnings.size(), 5U);
    EXPECT_EQ(read.warnings[1], "12 values of exactly 0: no signal, not black");
    EXPECT_TRUE(read.warnings[2].starts_with("2 directions were"));  // theta 0, at two phis
    EXPECT_NE(read.warnings[3].find("negative values"), std::string::npos);
}

}  // namespace
}  // namespace gonio::proc
