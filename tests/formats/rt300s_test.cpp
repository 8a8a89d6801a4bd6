#include "proc/formats/rt300s.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proc/formats/file_bytes.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/data_file.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;

std::string smallScan() {
    return "azimuth_deg,incidence_deg,receive_deg,RT\n"
           "-90,10,-80,0.0022\n"
           "-90,10,10,-0.004\n"
           "90,30,75.5,1e-3\n";
}

std::string smallJdv() {
    return "DataType:\tBRDF(RT-300S)\t \t\r"
           "SampleID:\tSample 0\t \t\r"
           "Date:\t7/12/2011\t\t\r"
           "Incidence:\t30\t \t\r"
           "Polar:\t-30,30,30\t \t\r"
           "Azimuth:\t-90,-80,10\t \t\r"
           "\t\t\t\r"
           "Raw data\t\t\t\r"
           "\t-30\t0\t30\r"
           "-90\t0\t1.5\t-2\r"
           "-80\t3\t4\t5\r"
           "\t\t\t\r";
}

FileRead<Rt300sScan> scanOf(const std::string& text) {
    auto read = parseRt300sCsv(text, "in.csv");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : FileRead<Rt300sScan>{};
}
FileRead<std::vector<JdvBlock>> blocksOf(const std::string& text) {
    auto read = parseJdv(text, "in.jdv");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : FileRead<std::vector<JdvBlock>>{};
}

TEST(Rt300s, ReadsReadings) {
    const FileRead<Rt300sScan> read = scanOf(smallScan());
    ASSERT_EQ(read.content.readings.size(), 3U);
    EXPECT_EQ(read.content.readings[2].azimuthDeg, 90);
    EXPECT_EQ(read.content.readings[2].incidenceDeg, 30);
    EXPECT_EQ(read.content.readings[2].receiveDeg, 75.5);
    EXPECT_EQ(read.content.readings[2].value, 1e-3);
    EXPECT_EQ(read.warnings, std::vector<std::string>{"1 negative values"});
    const FileRead<Rt300sScan> other =
        scanOf("RT,receive_deg,azimuth_deg,incidence_deg\n1,2,3,4\n");
    EXPECT_EQ(other.content.readings[0].incidenceDeg, 4);
}

/// The blank is no white noise about 0: what SOURCES.md of the campaign says of it.
TEST(Rt300s, KnowsTheRealBlank) {
    const auto path = test::dataFile("gonio_rt300s/blank_v2o0_20250911.RT.csv");
    if (!path) return;
    const std::vector<Rt300sReading> readings = scanOf(*readFile(*path)).content.readings;
    ASSERT_EQ(readings.size(), 2508U);
    double sum = 0, squares = 0, least = 1, most = -1;
    std::size_t negative = 0;
    for (const Rt300sReading& r : readings) {
        sum += r.value;
        least = std::min(least, r.value);
        most = std::max(most, r.value);
        negative += r.value < 0 ? 1U : 0U;
    }
    const double mean = sum / 2508;
    for (const Rt300sReading& r : readings) squares += (r.value - mean) * (r.value - mean);
    EXPECT_NEAR(mean, -0.00049, 0.000005);
    EXPECT_NEAR(std::sqrt(squares / 2507), 0.00152, 0.000005);
    EXPECT_EQ(least, -0.00242);
    EXPECT_EQ(most, 0.00473);
    EXPECT_NEAR(static_cast<double>(negative) / 2508, 0.74, 0.005);
}

TEST(Rt300s, CountsTheRealScans) {
    for (const auto& [name, count] :
         {std::pair{"ANOPLATE_AnoBlack_EC1_Alum6061_v1o0_20251115", 2508U},
          std::pair{"NiTE_on_steel_v1o0A_20250915", 2508U},
          std::pair{"NiTE_on_steel_v1o0B_20250916", 2508U},
          std::pair{"NiTE_on_steel_v1o0C_20250916", 2508U},
          std::pair{"MagicBlack_v2o0_20250902", 2376U}}) {
        const auto path = test::dataFile("gonio_rt300s/" + std::string(name) + ".RT.csv");
        if (!path) return;
        EXPECT_EQ(scanOf(*readFile(*path)).content.readings.size(), count) << name;
    }
}

TEST(Rt300s, ReadsTheRealJdvExport) {
    const auto path = test::dataFile("vendor_exports/test_jdv.jdv");
    if (!path) return;
    const std::string text = *readFile(*path);
    EXPECT_TRUE(isJdv(text));
    const FileRead<std::vector<JdvBlock>> read = blocksOf(text);
    ASSERT_EQ(read.content.size(), 4U);
    for (const JdvBlock& block : read.content) EXPECT_EQ(block.scan.readings.size(), 6U);
    EXPECT_EQ(read.content[1].sampleId, "Sample 60");
    EXPECT_EQ(read.content[1].scan.readings[0].incidenceDeg, 60);
    EXPECT_EQ(read.content[3].date, "7/12/2011");
    EXPECT_EQ(read.content[3].scan.readings[5].value, -42487.36);
    EXPECT_EQ(read.content[3].scan.readings[5].receiveDeg, 30);
    EXPECT_EQ(read.warnings,
              (std::vector<std::string>{"12 negative values", "12 values of exactly 0"}));
}

TEST(Rt300s, ReadsJdvBlocks) {
    const FileRead<std::vector<JdvBlock>> read = blocksOf(smallJdv() + smallJdv());
    ASSERT_EQ(read.content.size(), 2U);
    const auto& readings = read.content[1].scan.readings;
    ASSERT_EQ(readings.size(), 6U);
    EXPECT_EQ(readings[5].azimuthDeg, -80);
    EXPECT_EQ(readings[5].receiveDeg, 30);
    EXPECT_EQ(readings[5].value, 5);
}

TEST(Rt300s, ReadsAnyLineEndsAndAByteOrderMark) {
    for (const char* end : {"\r\n", "\r", "\n"}) {
        std::string scan = "\xEF\xBB\xBF", jdv = "\xEF\xBB\xBF";
        for (const char c : smallScan()) scan += c == '\n' ? std::string(end) : std::string(1, c);
        for (const char c : smallJdv()) jdv += c == '\r' ? std::string(end) : std::string(1, c);
        EXPECT_EQ(scanOf(scan).content.readings.size(), 3U);
        EXPECT_EQ(blocksOf(jdv).content.size(), 1U);
        EXPECT_TRUE(isJdv(jdv));
        EXPECT_TRUE(refuses(parseRt300sCsv(replaced(scan, "0.0022", "x"), "in"),
                            {"rt300s: in: line 2: RT: 'x', wanted a number"}));
        EXPECT_TRUE(refuses(parseJdv(replaced(jdv, "1.5", "x"), "in"), {"jdv: in: line 10: 'x'"}));
    }
}

TEST(Rt300s, SaysWhatIsWrongWithReadings) {
    const auto refused = [](std::string_view from, std::string_view to) {
        return parseRt300sCsv(replaced(smallScan(), from, to), "in");
    };
    for (const char* word : {"banana", "nan", "inf", "-inf", "1e999", "0x10", "1.5.2", ""}) {
        EXPECT_TRUE(refuses(refused("0.0022", word), {"rt300s: in: line 2: RT: "})) << word;
    }
    EXPECT_TRUE(refuses(refused("0.0022", "0,0022"), {"line 2: 5 fields", "a decimal comma?"}));
    EXPECT_TRUE(refuses(refused("-90,10,10,", "-90,10,"), {"line 3: 3 fields"}));
    EXPECT_TRUE(refuses(refused("-90,10,10,", "-90,10,-80,"),
                        {"two readings at azimuth -90, incidence 10, receive -80"}));
    EXPECT_TRUE(refuses(refused("-90,10,10,", "-90,90,10,"), {"line 3: incidence 90"}));
    EXPECT_TRUE(refuses(refused("-90,10,10,", "-90,-1,10,"), {"line 3: incidence -1"}));
    EXPECT_TRUE(refuses(refused("-90,10,10,", "-90,10,-90,"), {"line 3: receive -90"}));
    EXPECT_TRUE(refuses(refused("-90,10,10,", "361,10,10,"), {"line 3: azimuth 361"}));
    EXPECT_TRUE(refuses(refused("receive_deg", "azimuth_deg"), {"line 1: the header"}));
    EXPECT_TRUE(refuses(refused(",RT\n", ",RT,more\n"), {"line 1: the header"}));
    EXPECT_TRUE(refuses(parseRt300sCsv("", "in"), {"rt300s: in: line 0: no reading"}));
    EXPECT_TRUE(refuses(parseRt300sCsv(smallScan() + "junk\n", "in"), {"line 5: 1 fields"}));
}

TEST(Rt300s, SaysWhatIsWrongWithJdv) {
    const auto refused = [](std::string_view from, std::string_view to) {
        return parseJdv(replaced(smallJdv(), from, to), "in");
    };
    for (const char* word : {"banana", "nan", "inf", "-inf", "1e999", "0x10", "1,5", "1.5.2"}) {
        EXPECT_TRUE(refuses(refused("1.5", word), {"jdv: in: line 10: "})) << word;
    }
    EXPECT_TRUE(refuses(refused("1.5\t", ""), {"line 10: 3 fields, the block promised 4"}));
    EXPECT_TRUE(refuses(refused("-80\t3", "-70\t3"), {"azimuth angle -70", "promised -80"}));
    EXPECT_TRUE(refuses(refused("\t-30\t0", "\t-30\t1"), {"polar angle 1", "promised 0"}));
    for (const char* steps : {"-30,30",
                              "-30,30,0.000001",
                              "30,-30,30",
                              "-30,30,7",
                              "1,2,x",
                              "-30,30,1e-300",
                              "0,1e308,1"}) {
        EXPECT_TRUE(refuses(refused("-30,30,30", steps), {"Polar:"})) << steps;
    }
    EXPECT_TRUE(refuses(refused("-90,-80,10", "-90,-60,10"), {"the text ends after 2 of 4 rows"}));
    EXPECT_TRUE(refuses(refused("Incidence:\t30", "Incidence:\t95"), {"incidence 95"}));
    EXPECT_TRUE(refuses(refused("BRDF(RT-300S)", "BRDF"), {"DataType 'BRDF'"}));
    EXPECT_TRUE(refuses(refused("SampleID:", "DataType:"), {"'DataType:', wanted SampleID:"}));
    EXPECT_TRUE(refuses(parseJdv("", "in"), {"jdv: in: line 0: the text ends, wanted DataType"}));
    EXPECT_TRUE(refuses(parseJdv(smallJdv() + "junk\r", "in"), {"'junk', wanted DataType:"}));
}

TEST(Rt300s, RefusesAJdvCutAtAnyByte) {
    const std::string text = smallJdv();
    const std::size_t whole = text.find("\t5\r");
    for (std::size_t size = 0; size <= whole; ++size) {
        EXPECT_TRUE(refuses(parseJdv(text.substr(0, size), "cut"), {"jdv: cut: line "})) << size;
    }
}

}  // namespace
}  // namespace gonio::proc
