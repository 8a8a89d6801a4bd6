#include "proc/formats/ssdd.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/table/specular_lookup.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/formats/spherical_files.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;
using test::sphericalTable;
using test::steps;

FileRead<SsddTable> parsed(std::string_view text) {
    auto read = parseSsdd(text, "in.ssdd");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(*read) : FileRead<SsddTable>{.content = {}, .about = {}};
}
SphericalTable sphericalOf(std::string_view text) {
    return std::get<SphericalTable>(parsed(text).content);
}

/// 2 incidences x 1 azimuth x 2 thetas x 3 phis; colours on lines 10..21.
std::string small() {
    std::string text =
        "VERSION 0.3\n"
        "# a comment\n"
        "DATA_TYPE brdf\n"
        "COLOR_MODEL monochrome\n"
        "PARAM_TYPE spherical_coordinate_system\n"
        "PARAM0_LIST 10 20\n"
        "PARAM2_LIST 0 60\nPARAM3_LIST 0 120 240\n"
        "DATA ascii\n";
    for (int i = 0; i < 12; ++i) text += "0." + std::to_string(i + 1) + "\n";
    return text;
}

TEST(SsddReader, PutsEachNumberInItsPlace) {
    const auto read = parsed(small());
    const auto& table = std::get<SphericalTable>(read.content);
    ASSERT_EQ(table.blocks.size(), 2U);
    EXPECT_EQ(table.mirrorAzimuthDeg, 180);
    EXPECT_EQ(table.channels, std::vector<Channel>{Channel{}});
    EXPECT_EQ(table.blocks[0].incidenceDeg, 10);
    EXPECT_EQ(table.blocks[0].f, (std::vector<double>{0.1, 0.3, 0.5, 0.7, 0.9, 0.11}));
    EXPECT_EQ(table.blocks[1].f, (std::vector<double>{0.2, 0.4, 0.6, 0.8, 0.10, 0.12}));
    EXPECT_EQ(read.about.comments, std::vector<std::string>{"a comment"});
    EXPECT_TRUE(read.warnings.empty());
}

TEST(SsddReader, ReadsTheSpecificationsExamples) {
    const std::string one =
        "VERSION 0.2\n\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\nPARAM_TYPE "
        "spherical_coordinate_system\nPARAM0_LIST 0\nPARAM2_LIST 0\nPARAM3_LIST 0\nDATA "
        "ascii\n0.3183\n";
    EXPECT_EQ(sphericalOf(one).blocks.at(0).f, std::vector<double>{0.3183});
    const std::string two =
        "VERSION 0.2\n"
        "# Orange diffuse BTDF in the CIE XYZ color space\n"
        "DATA_TYPE btdf\nCOLOR_MODEL xyz\nPARAM_TYPE specular_coordinate_system\n"
        "REDUCTION_TYPE bilateral_symmetry\nPARAM0_LIST 0 90\nPARAM2_LIST 0 180\n"
        "PARAM3_LIST 0 180\nDATA ascii\n# PARAM3: 0\n# PARAM2: 0\n"
        "0.1 0.2 0.3\n1 2 3\n# PARAM2: 180\n0.4 0.5 0.6\n1 2 3\n# PARAM3: 180\n# PARAM2: 0\n"
        "0.1 0.2 0.3\n1 2 3\n# PARAM2: 180\n0.7 0.8 0.9\n1 2 3\n\n"
        "# Simple specular reflectance\nDATA_TYPE specular_reflectance\nCOLOR_MODEL spectrum\n"
        "WAVELENGTH_LIST 400 450\nPARAM0_LIST 0 90\nDATA ascii\n0.05 0.05\n0.05 0.05\n";
    const auto read = parsed(two);
    const auto& table = std::get<SpecularTable>(read.content);
    EXPECT_EQ(table.kind, ScatterKind::Btdf);
    EXPECT_EQ(table.colour, TableColour::Xyz);
    EXPECT_EQ(table.symmetry, TableSymmetry::PlaneSymmetrical);
    EXPECT_EQ(table.incidenceDeg, std::vector<double>{0});
    ASSERT_EQ(table.planes.size(), 3U);
    EXPECT_EQ(table.planes[1].f, (std::vector<double>{0.2, 0.5, 0.2, 0.8}));
    ASSERT_EQ(read.warnings.size(), 2U);
    EXPECT_NE(read.warnings[0].find("incidence 90"), std::string::npos);
    EXPECT_NE(read.warnings[1].find("specular_reflectance is not read"), std::string::npos);
    EXPECT_EQ(read.about.comments.at(0), "Orange diffuse BTDF in the CIE XYZ color space");
}

TEST(SsddReader, HasTheCoordinatesOfSpecularTables) {
    // One light at azimuth 90: the nodes of a 4-D table turned by -90.
    std::string text =
        "VERSION 0.3\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\n"
        "PARAM_TYPE specular_coordinate_system\nPARAM0_LIST 30\nPARAM1_LIST 0 90 180 270 360\n"
        "PARAM2_LIST 0 20\nPARAM3_LIST 0 90 180 270 360\nDATA ascii\n";
    for (int p3 = 0; p3 < 5; ++p3) {
        for (int p2 = 0; p2 < 2; ++p2) {
            for (int p1 = 0; p1 < 5; ++p1) {
                text += std::to_string(1 + p1 % 4 + 10 * p2 * (1 + p3 % 4)) + "\n";
            }
        }
    }
    const auto lookup = SpecularLookup::over(std::get<SpecularTable>(parsed(text).content));
    ASSERT_TRUE(lookup);
    for (int p1 = 0; p1 < 4; ++p1) {
        const Direction wi = Direction::fromSpherical(30_deg, Radians::fromDegrees(90.0 * p1));
        EXPECT_NEAR(lookup->answer({.in = wi, .out = mirrorOf(wi)}).f[Band::R], 1 + p1, 1e-9);
        const Direction up =
            Direction::fromSpherical(10_deg, Radians::fromDegrees(90.0 * p1 + 180));
        EXPECT_NEAR(lookup->answer({.in = wi, .out = up}).f[Band::R], 11 + p1, 1e-9);
    }
}

TEST(SsddReader, RefusesATextCutAnywhere) {
    const std::string text = small();
    for (std::size_t size = 0; size + 4 < text.size(); ++size) {
        EXPECT_TRUE(refuses(parseSsdd(text.substr(0, size), "cut"), {"ssdd: cut: line "})) << size;
    }
}

TEST(SsddReader, TakesAnyLineEndAndCase) {
    for (const char* end : {"\r\n", "\r", "\n\n"}) {
        std::string text;
        for (const char c : small()) text += c == '\n' ? std::string(end) : std::string(1, c);
        EXPECT_EQ(sphericalOf(text).blocks[1].f, sphericalOf(small()).blocks[1].f);
    }
    std::string upper = small();
    for (char& c : upper) c = static_cast<char>(std::toupper(c));
    EXPECT_EQ(sphericalOf(upper).blocks[1].f, sphericalOf(small()).blocks[1].f);
    EXPECT_EQ(sphericalOf("\xEF\xBB\xBF" + small()).blocks.size(), 2U);
}

TEST(SsddReader, RefusesWhatIsNoFiniteNumber) {
    for (const char* word : {"banana", "nan", "inf", "1e999", "0x10", "0,3"}) {
        EXPECT_TRUE(refuses(parseSsdd(replaced(small(), "0.4\n", std::string(word) + "\n"), "in"),
                            {"line 13", word, "is not a finite number"}));
        EXPECT_TRUE(refuses(parseSsdd(replaced(small(), "0 120", "0 " + std::string(word)), "in"),
                            {"line 8", word, "wanted numbers"}));
    }
}

TEST(SsddReader, RefusesWhatDoesNotFit) {
    const auto wrong = [](std::string_view from, std::string_view to) {
        return parseSsdd(replaced(small(), from, to), "in");
    };
    EXPECT_TRUE(refuses(parseSsdd("", "in"), {"no brdf or btdf"}));
    EXPECT_TRUE(refuses(wrong("VERSION 0.3\n", ""), {"wanted VERSION"}));
    EXPECT_TRUE(refuses(wrong("VERSION 0.3", "VERSION 7"), {"wanted VERSION 0.1, 0.2 or 0.3"}));
    EXPECT_TRUE(refuses(wrong("0.4\n", "0.3 0.4\n"), {"2 values in a line, wanted 1"}));
    EXPECT_TRUE(refuses(parseSsdd(small() + "0.5\n", "in"), {"'0.5', wanted DATA_TYPE"}));
    EXPECT_TRUE(refuses(wrong("PARAM2_LIST 0 60", "PARAM2_LIST 60 0"), {"must ascend"}));
    EXPECT_TRUE(refuses(wrong("PARAM2_LIST 0 60", "PARAM2_LIST 0 91"), {"PARAM2_LIST", "90"}));
    EXPECT_TRUE(refuses(wrong("PARAM2_LIST 0 60", "PARAM0_LIST 0 60"), {"given twice"}));
    EXPECT_TRUE(refuses(wrong("PARAM2_LIST 0 60\n", ""), {"no PARAM2_LIST"}));
    EXPECT_TRUE(refuses(wrong("PARAM2_LIST 0 60", "PARAM9_LIST 0 60"), {"unknown property"}));
    EXPECT_TRUE(refuses(wrong("COLOR_MODEL monochrome\n", ""), {"no COLOR_MODEL"}));
    EXPECT_TRUE(refuses(wrong("monochrome", "spectrum"), {"no WAVELENGTH_LIST"}));
    EXPECT_TRUE(refuses(wrong("monochrome", "cmyk"), {"'cmyk' is no COLOR_MODEL"}));
    EXPECT_TRUE(refuses(wrong("DATA_TYPE brdf", "DATA_TYPE bssrdf"), {"is no DATA_TYPE"}));
    EXPECT_TRUE(refuses(wrong("DATA ascii", "DATA text"), {"wanted DATA ascii or binary"}));
    for (const char* type :
         {"half_difference_coordinate_system", "distorted_spherical_coordinate_system"}) {
        EXPECT_TRUE(refuses(wrong("spherical_coordinate_system", type), {type, "is not read"}));
    }
    EXPECT_TRUE(refuses(parseSsdd(small() + small().substr(12), "in"), {"a second block of brdf"}));
    EXPECT_TRUE(
        refuses(wrong("PARAM0_LIST", "REDUCTION_TYPE reciprocity\nPARAM0_LIST"), {"reciprocity"}));
    EXPECT_TRUE(refuses(wrong("PARAM0_LIST", "REDUCTION_TYPE bilateral_symmetry\nPARAM0_LIST"),
                        {"beyond 180"}));
    EXPECT_TRUE(refuses(
        wrong("PARAM0_LIST", "REDUCTION_TYPE bilateral_symmetry\nPARAM1_LIST 30\nPARAM0_LIST"),
        {"light at azimuth 30", "wanted 0"}));
}

TEST(SsddReader, RefusesGridsThatTheFileCannotHold) {
    std::string wide =
        "VERSION 0.3\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\n"
        "PARAM_TYPE spherical_coordinate_system\n";
    for (const char* list : {"PARAM0_LIST", "PARAM1_LIST", "PARAM2_LIST", "PARAM3_LIST"}) {
        wide += list;
        for (int i = 0; i < 2000; ++i) wide += " " + std::to_string(0.01 * i);
        wide += "\n";
    }
    EXPECT_TRUE(refuses(parseSsdd(wide + "DATA ascii\n0.1\n", "in"),
                        {"a grid of 2000 x 2000 x 2000 x 2000 colours"}));
    EXPECT_TRUE(refuses(parseSsdd(wide + "DATA binary\n0.1\n", "in"), {"a grid of 2000 x 2000"}));
}

TEST(SsddWriter, ReadsBackTheSameBytesAndModels) {
    for (const char* spec : {"lambert,albedo=0.3/0.2/0.1", "ggx,alpha=0.3,f0=0.5/0.4/0.3"}) {
        for (const bool symmetrical : {false, true}) {
            for (const SsddData data : {SsddData::Ascii, SsddData::Binary}) {
                const SphericalTable table =
                    sphericalTable({.channels = Channel::ofBands(),
                                    .planeSymmetrical = symmetrical,
                                    .azimuthDeg = steps(0, symmetrical ? 180 : 360, 10),
                                    .thetaDeg = steps(0, 85, 5)},
                                   test::ModelValue(spec));
                Metadata about;
                about.set(key::kSample, "two\nlines # and more");
                about.set(key::kDate, "2026-11-30T12:00:00Z");
                about.comments = {"free text"};
                const auto once = writeSsdd(table, about, data);
                ASSERT_TRUE(once);
                const auto read = parsed(once->bytes);
                const auto& back = std::get<SphericalTable>(read.content);
                const bool binary = data == SsddData::Binary;
                test::expectSameAtNodes(table, back, binary ? 1e-7 : 1e-12);
                EXPECT_EQ(back.planeSymmetrical, symmetrical);
                EXPECT_EQ(read.about, about);
                EXPECT_EQ(writeSsdd(back, read.about, data)->bytes, once->bytes);
                ASSERT_EQ(once->loss.items.size(), binary ? 1U : 0U);
                if (binary) {
                    EXPECT_LT(*once->loss.items[0].largestError, 6e-8);
                    EXPECT_GT(*once->loss.items[0].largestError, 0);
                }
            }
        }
    }
}

TEST(SsddWriter, KeepsHandednessTransmissionAndLightAzimuths) {
    const auto value = [](const LightView& pair, std::size_t) { return test::handedValue(pair); };
    for (const double mirror : {0.0, 180.0, 270.0}) {
        SphericalTable table = sphericalTable({.mirrorAzimuthDeg = mirror,
                                               .lightAzimuthDeg = {0, 120, 240},
                                               .thetaDeg = steps(0, 85, 5)},
                                              value);
        const SphericalTable behind = sphericalTable({.mirrorAzimuthDeg = mirror,
                                                      .lightAzimuthDeg = {0, 120, 240},
                                                      .thetaDeg = steps(95, 180, 5),
                                                      .transmission = true},
                                                     value);
        table.blocks.insert(table.blocks.end(), behind.blocks.begin(), behind.blocks.end());
        const auto once = writeSsdd(table, {});
        ASSERT_TRUE(once);
        EXPECT_TRUE(once->loss.items.empty());
        const SphericalTable back = sphericalOf(once->bytes);
        ASSERT_EQ(back.blocks.size(), 24U);
        test::expectSameAtNodes(table, back, 1e-12);
        EXPECT_EQ(writeSsdd(back, {})->bytes, once->bytes);
    }
}

TEST(SsddWriter, PutsTheLobeAtTheMirrorDirection) {
    const SphericalTable table = sphericalTable(
        {.mirrorAzimuthDeg = 0, .azimuthDeg = steps(0, 355, 5)},
        [](const LightView& pair, std::size_t) { return test::mirrorLobe(pair, 3); });
    test::expectPeaksAtMirror(sphericalOf(writeSsdd(table, {})->bytes));
}

TEST(SsddWriter, NamesItsColours) {
    const auto value = [](const LightView&, std::size_t channel) {
        return 1.0 + static_cast<double>(channel);
    };
    const std::vector<std::vector<Channel>> kinds{
        {Channel{}},
        {{"R", {}}, {"G", {}}, {"B", {}}},
        {{"X", {}}, {"Y", {}}, {"Z", {}}},
        {{"", 400}, {"", 500}},
    };
    for (const auto& channels : kinds) {
        const SphericalTable table = sphericalTable({.channels = channels}, value);
        const SphericalTable back = sphericalOf(writeSsdd(table, {})->bytes);
        EXPECT_EQ(back.channels, channels);
        EXPECT_EQ(back.blocks.back().f[0], static_cast<double>(channels.size()));
    }
    EXPECT_EQ(
        writeSsdd(sphericalTable({.channels = {{"a", {}}, {"b", {}}}}, value), {}).error().kind,
        ErrorKind::Usage);
    EXPECT_EQ(writeSsdd({}, {}).error().kind, ErrorKind::Usage);
}

TEST(SsddWriter, ReportsWhatIsLost) {
    SphericalTable table = sphericalTable({}, [](const LightView&, std::size_t) { return 1.0; });
    table.blocks[0].f[3] = std::nan("");
    table.blocks[0].tis = 0.5;
    table.blocks[2].thetaDeg[1] = 7;
    const auto written = writeSsdd(table, {});
    ASSERT_TRUE(written);
    EXPECT_EQ(written->loss.items,
              (std::vector<LossReport::Item>{
                  {Loss::Masked, "nodes without data, written as 0", 1},
                  {Loss::Dropped, "TIS as stated", 1},
                  {Loss::Dropped, "blocks on other axes than the first of their kind", 1}}));
}

}  // namespace
}  // namespace gonio::proc
