#include "proc/formats/zemax.h"

#include <gtest/gtest.h>

#include <bit>
#include <cctype>
#include <cmath>
#include <limits>
#include <random>

#include "proc/formats/file_bytes.h"
#include "proc/table/specular_integral.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/data_file.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

using test::dataFile;
using test::refuses;
using test::replaced;
using test::smallZemax;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

SpecularTable parsed(std::string_view text) {
    auto table = parseZemax(text, "in.bsdf");
    EXPECT_TRUE(table) << (table ? "" : table.error().message);
    return table ? std::move(*table) : SpecularTable{};
}

void expectSame(const SpecularTable& a, const SpecularTable& b) {
    EXPECT_EQ(a.symmetry, b.symmetry);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.colour, b.colour);
    EXPECT_EQ(a.rotationDeg, b.rotationDeg);
    EXPECT_EQ(a.incidenceDeg, b.incidenceDeg);
    EXPECT_EQ(a.azimuthDeg, b.azimuthDeg);
    EXPECT_EQ(a.radialDeg, b.radialDeg);
    ASSERT_EQ(a.planes.size(), b.planes.size());
    for (std::size_t i = 0; i < a.planes.size(); ++i) {
        EXPECT_EQ(a.planes[i].f, b.planes[i].f);
        EXPECT_EQ(a.planes[i].tis, b.planes[i].tis);
    }
}

/// Finite doubles of every magnitude and sign. No radial 0, whose values would have to agree.
SpecularTable randomTable(std::mt19937_64& random) {
    const auto any = [&] {
        for (;;) {
            const double value = std::bit_cast<double>(random());
            if (std::isfinite(value)) return value;
        }
    };
    SpecularTable table;
    table.symmetry = static_cast<TableSymmetry>(random() % 3);
    table.kind = static_cast<ScatterKind>(random() % 2);
    table.colour = static_cast<TableColour>(random() % 2);
    table.rotationDeg = {-90, 0.1, 45};
    table.incidenceDeg = {0, 1.0 / 3, 89.999};
    table.azimuthDeg = {0, 22.5, 180};
    table.radialDeg = {1e-300, 0.7, 90, 180};
    table.comments = {"Wavelength (nm) = 525", "", "  two spaces first"};
    table.planes.resize(table.colour == TableColour::Xyz ? 3 : 1);
    for (TablePlane& plane : table.planes) {
        for (std::size_t i = 0; i < table.nodeCount(); ++i) plane.f.push_back(any());
        for (std::size_t i = 0; i < 9; ++i) plane.tis.push_back(any());
    }
    return table;
}

/// Where each number of a text stands.
struct Place {
    std::size_t at = 0, size = 0;
    int line = 1;
};
std::vector<Place> numbersOf(std::string_view text) {
    std::vector<Place> places;
    int line = 1;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == '\n') ++line;
        if (std::isdigit(text[at]) == 0) continue;
        const std::size_t end = text.find_first_of(" \t\n", at);
        places.push_back({at, end - at, line});
        at = end - 1;
    }
    return places;
}

TEST(Zemax, ReadsBackEveryBitOfATable) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 200; ++i) {
        const SpecularTable table = randomTable(random);
        const Written written = writeZemax(table);
        EXPECT_TRUE(written.loss.items.empty());
        const SpecularTable back = parsed(written.bytes);
        expectSame(back, table);
        EXPECT_EQ(back.comments, table.comments);
        EXPECT_EQ(writeZemax(back).bytes, written.bytes);
    }
}

TEST(Zemax, WritesTheSameBytesAgainForAMeasuredFile) {
    const auto text = readFile(std::filesystem::path(GONIO_SOURCE_DIR) / "config" / "demo" /
                               "AnoBlackEC1onAlum.bsdf");
    ASSERT_TRUE(text);
    const SpecularTable table = parsed(*text);
    EXPECT_EQ(table.symmetry, TableSymmetry::PlaneSymmetrical);
    EXPECT_EQ(table.incidenceDeg, (std::vector<double>{10, 30, 50, 70}));
    EXPECT_EQ(table.azimuthDeg.size(), 19U);
    EXPECT_EQ(table.radialDeg.size(), 12U);
    EXPECT_EQ(table.planes.at(0).tis.at(0), 0.038655);
    EXPECT_EQ(table.planes[0].f[table.index({0, 0, 1, 1})], 3.323e-02);
    EXPECT_EQ(table.planes[0].f[table.index({0, 3, 18, 2})], 1.868);
    EXPECT_EQ(table.comments.at(4), "Sample: Anoplate AnoBlack EC1 on Alum 6061 (So #: 1114817)");
    const std::string once = writeZemax(table).bytes;
    EXPECT_EQ(writeZemax(parsed(once)).bytes, once);
    expectSame(parsed(once), table);
}

TEST(Zemax, ReadsEveryMeasuredFileThereIs) {
    const auto folder = dataFile("gonio_rt300s");
    if (!folder) return;
    for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
        if (entry.path().extension() != ".bsdf") continue;
        const auto table = readZemax(entry.path());
        ASSERT_TRUE(table) << table.error().message;
        const std::string once = writeZemax(*table).bytes;
        EXPECT_EQ(writeZemax(parsed(once)).bytes, once) << entry.path();
    }
}

TEST(Zemax, RefusesTheExportsOfOtherPrograms) {
    for (const char* name : {"test_lighttools.txt", "test_jdv.jdv", "R_test.anisotropicbsdf"}) {
        const auto file = dataFile("vendor_exports/" + std::string(name));
        if (!file) continue;
        EXPECT_TRUE(refuses(readZemax(*file), {"zemax: ", name, ": line "}));
    }
}

TEST(Zemax, KnowsEverySpellingOfTheSymmetries) {
    const auto spelt = [](std::string_view word) {
        return parsed(replaced(smallZemax(), "PlaneSymmetrical", word)).symmetry;
    };
    for (const char* word : {"PlaneSymmetrical", "planesymmetrical", "PLANESYMMETRICAL"}) {
        EXPECT_EQ(spelt(word), TableSymmetry::PlaneSymmetrical);
    }
    for (const char* word : {"Asymmetrical", "ASymmetrical", "asymmetrical"}) {
        EXPECT_EQ(spelt(word), TableSymmetry::Asymmetrical);
    }
    for (const char* word : {"Asymmetrical4D", "ASymmetrical4D", "asymmetrical4d"}) {
        EXPECT_EQ(spelt(word), TableSymmetry::Asymmetrical4D);
    }
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "PlaneSymmetrical", "Isotropic"), "in"),
                        {"line 3", "'Isotropic'", "PlaneSymmetrical, Asymmetrical"}));
}

TEST(Zemax, WritesTheSpellingsThatOtherReadersTake) {
    SpecularTable table = parsed(smallZemax());
    table.symmetry = TableSymmetry::Asymmetrical;
    EXPECT_NE(writeZemax(table).bytes.find("Symmetry  Asymmetrical\n"), std::string::npos);
    table.symmetry = TableSymmetry::Asymmetrical4D;
    EXPECT_NE(writeZemax(table).bytes.find("Symmetry  ASymmetrical4D\n"), std::string::npos);
}

TEST(Zemax, DoesNotCareForTheCaseOfKeywords) {
    std::string upper = smallZemax();
    std::string lower = smallZemax();
    for (char& c : upper) c = static_cast<char>(std::toupper(c));
    for (char& c : lower) c = static_cast<char>(std::tolower(c));
    expectSame(parsed(upper), parsed(smallZemax()));
    expectSame(parsed(lower), parsed(smallZemax()));
}

TEST(Zemax, TakesAnyWhiteSpaceAndLineEnd) {
    for (const char* space : {" ", "\t", "   ", " \t ", "\f", "\v", "\n", "\r\n", "\r", "\t\r\n"}) {
        std::string text;
        for (const char c : smallZemax().substr(12)) {  // without the comment, which ends its line
            text += c == ' ' || c == '\t' || c == '\n' ? std::string(space) : std::string(1, c);
        }
        expectSame(parsed(text), parsed(smallZemax()));
    }
}

TEST(Zemax, CountsLinesAndEndsCommentsAtEveryLineEnd) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const char c : replaced(smallZemax(), "0.4\t0.1", "0.4\tbanana")) {
            text += c == '\n' ? std::string(end) : std::string(1, c);
        }
        EXPECT_TRUE(refuses(parseZemax(text, "in"), {"zemax: in: line 18: 'banana'"}));
        const SpecularTable table = parsed(replaced(text, "banana", "0.1"));
        EXPECT_EQ(table.comments, std::vector<std::string>{"a comment"});
        expectSame(table, parsed(smallZemax()));
    }
}

TEST(Zemax, TakesListsOverSeveralLines) {
    const std::string text = replaced(smallZemax(), "0\t90\t180", "0\n90 \n\n180");
    expectSame(parsed(replaced(text, "0.5\t0.4\t0.1\n0.5", "0.5\n0.4\n0.1 0.5")),
               parsed(smallZemax()));
}

TEST(Zemax, TakesCommentsAnywhereAndKeepsThem) {
    std::string text = replaced(smallZemax(), "0\t90\t180", "0\t90 # middle\n180");
    text = replaced(text, "TIS  0.3\n", "TIS  #  before\n0.3\n#\n");
    text += "# last, without a line end";
    const SpecularTable table = parsed(text);
    expectSame(table, parsed(smallZemax()));
    EXPECT_EQ(table.comments,
              (std::vector<std::string>{
                  "a comment", "middle", " before", "", "last, without a line end"}));
    EXPECT_EQ(parsed(writeZemax(table).bytes).comments, table.comments);
}

TEST(Zemax, KeepsACommentOnItsLine) {
    SpecularTable table = parsed(smallZemax());
    table.comments = {"one\ntwo\rthree"};
    const SpecularTable back = parsed(writeZemax(table).bytes);
    EXPECT_EQ(back.comments, std::vector<std::string>{"one two three"});
    expectSame(back, table);
}

TEST(Zemax, TakesTheHeaderInAnyOrderAndWithoutWhatHasADefault) {
    std::string text = replaced(smallZemax(), "Source  Measured\n", "");
    text = replaced(text, "ScatterType  BRDF\n", "");
    text = replaced(text, "SampleRotation  1\n0\n", "");
    text = replaced(text, "ScatterRadial  3\n0\t20\t40\n", "");
    text = replaced(text, "Symmetry", "ScatterRadial  3\n0\t20\t40\nSymmetry");
    expectSame(parsed(text), parsed(smallZemax()));
}

TEST(Zemax, NamesWhatTheHeaderLacks) {
    for (const std::string line : {"Symmetry  PlaneSymmetrical\n",
                                   "SpectralContent  Monochrome\n",
                                   "AngleOfIncidence  2\n10\t30\n",
                                   "ScatterAzimuth  3\n0\t90\t180\n",
                                   "ScatterRadial  3\n0\t20\t40\n"}) {
        const std::string keyword = line.substr(0, line.find(' '));
        EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), line, ""), "in"),
                            {"the header has no " + keyword}));
    }
    EXPECT_TRUE(refuses(parseZemax("", "in"), {"in: line 1: the text ends, wanted Symmetry"}));
}

TEST(Zemax, RefusesWhatItDoesNotKnowOrIsGivenTwice) {
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "Source", "Sauce"), "in"),
                        {"line 2", "unknown keyword 'Sauce'"}));
    EXPECT_TRUE(
        refuses(parseZemax(replaced(smallZemax(), "ScatterType  BRDF", "Source  Measured"), "in"),
                {"line 5", "'Source' is given twice"}));
    EXPECT_TRUE(refuses(parseZemax(smallZemax() + "more", "in"), {"line 26", "'more'"}));
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "Monochrome\nData", "Data"), "in"),
                        {"line 15", "'DataBegin'"}));
    EXPECT_TRUE(
        refuses(parseZemax(replaced(smallZemax(), "\nMonochrome\n", "\nTristimulusX\n"), "in"),
                {"line 15", "'TristimulusX', wanted Monochrome"}));
}

TEST(Zemax, RefusesWhatIsNoFiniteNumberWhereverOneStands) {
    const std::string text = smallZemax();
    for (const Place& place : numbersOf(text)) {
        for (const char* word : {"banana", "nan", "inf", "-inf", "1e999", "0x10", "1,5", "1.5.2"}) {
            std::string wrong = text;
            wrong.replace(place.at, place.size, word);
            EXPECT_TRUE(refuses(
                parseZemax(wrong, "in.bsdf"),
                {"zemax: in.bsdf: line " + std::to_string(place.line) + ": '" + word + "'"}));
        }
    }
}

TEST(Zemax, RefusesATextCutAtAnyByte) {
    const std::string text = smallZemax();
    for (std::size_t size = 0; size + 1 < text.size(); ++size) {
        EXPECT_TRUE(
            refuses(parseZemax(text.substr(0, size), "cut.bsdf"), {"zemax: cut.bsdf: line "}));
    }
    expectSame(parsed(text.substr(0, text.size() - 1)), parsed(text));
}

TEST(Zemax, RefusesAnyOtherNumberOfValuesThanPromised) {
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "0.5\t0.4\t0.1", "0.5\t0.4"), "in"),
                        {"line 21", "8 values in block, header promised 9"}));
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "0.3\t0\n", "0.3\t0\t0\n"), "in"),
                        {"line 24", "more than 9 values in block, header promised 9"}));
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "TIS  0.3\n", ""), "in"),
                        {"line 21", "header promised 9"}));
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "10\t30", "10"), "in"),
                        {"number 2 of the 2 of AngleOfIncidence"}));
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "10\t30", "10\t30\t50"), "in"),
                        {"unknown keyword '50'"}));
}

TEST(Zemax, RefusesHugeCountsBeforeItMakesRoom) {
    for (const char* keyword :
         {"SampleRotation  1", "AngleOfIncidence  2", "ScatterAzimuth  3", "ScatterRadial  3"}) {
        const std::string name(keyword, std::string_view(keyword).find(' '));
        for (const char* count : {"1000000000", "9223372036854775807", "4294967297"}) {
            const std::string text = replaced(smallZemax(), keyword, name + "  " + count);
            EXPECT_TRUE(refuses(parseZemax(text, "in"), {name, count, "bytes are left"}));
        }
        for (const char* count : {"0", "-1", "9223372036854775808", "1.5", "1e3"}) {
            const std::string text = replaced(smallZemax(), keyword, name + "  " + count);
            EXPECT_TRUE(refuses(parseZemax(text, "in"), {"the number of values of " + name}));
        }
    }
}

TEST(Zemax, RefusesAxesWhoseProductIsMoreThanTheTextHolds) {
    std::string text = "Symmetry Asymmetrical SpectralContent Monochrome\n";
    for (const char* keyword :
         {"SampleRotation", "AngleOfIncidence", "ScatterAzimuth", "ScatterRadial"}) {
        text += std::string(keyword) + " 800\n";
        for (int i = 0; i < 800; ++i)
            text += std::to_string(i / 10) + "." + std::to_string(i % 10) + " ";
    }
    text += "Monochrome DataBegin TIS 0 0 0 DataEnd";
    EXPECT_TRUE(refuses(parseZemax(text, "in"), {"the header promises 409600000000 values"}));
}

TEST(Zemax, RefusesAnglesThatDoNotAscendOrLieOutside) {
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "10\t30", "30\t10"), "in"),
                        {"line 9", "more than 30", "AngleOfIncidence must ascend"}));
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "0\t20\t40", "0\t20\t20"), "in"),
                        {"line 13", "ScatterRadial must ascend"}));
    EXPECT_TRUE(
        refuses(parseZemax(replaced(smallZemax(), "10\t30", "-1\t30"), "in"), {"[0, 180]"}));
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "0\t20\t40", "0\t20\t180.1"), "in"),
                        {"[0, 180]"}));
    EXPECT_TRUE(refuses(parseZemax(replaced(smallZemax(), "0\t90\t180", "0\t90\t361"), "in"),
                        {"[0, 360]"}));
}

TEST(Zemax, HoldsHalfTheAzimuthsOfAPlaneSymmetricalTable) {
    const std::string wide = replaced(smallZemax(), "0\t90\t180", "0\t90\t180.5");
    EXPECT_TRUE(refuses(parseZemax(wide, "in"), {"PlaneSymmetrical", "180.5", "at most 180"}));
    EXPECT_EQ(parsed(replaced(wide, "PlaneSymmetrical", "Asymmetrical")).azimuthDeg.back(), 180.5);
}

TEST(Zemax, TakesIncidencesBelowTheHorizonInReflectionAndAnyInTransmission) {
    for (const char* incidence : {"90", "120"}) {
        const std::string text = replaced(smallZemax(), "10\t30", std::string("10\t") + incidence);
        EXPECT_TRUE(refuses(parseZemax(text, "in"), {"BRDF", incidence, "below 90"}));
        const SpecularTable table = parsed(replaced(text, "BRDF", "BTDF"));
        EXPECT_EQ(table.kind, ScatterKind::Btdf);
        EXPECT_EQ(parsed(writeZemax(table).bytes).kind, ScatterKind::Btdf);
    }
    EXPECT_EQ(parsed(replaced(smallZemax(), "10\t30", "10\t89.9")).incidenceDeg[1], 89.9);
}

TEST(Zemax, TakesTheMeanAtRadialZero) {
    const auto centre = [](const char* rows) {
        const SpecularTable table =
            parsed(replaced(smallZemax(), "0.5\t0.4\t0.1\n0.5\t0.3\t0.2\n0.5\t0.2\t0.3\n", rows));
        std::vector<double> seen;
        for (std::size_t a = 0; a < 3; ++a)
            seen.push_back(table.planes[0].f[table.index({0, 0, a, 0})]);
        return seen;
    };
    EXPECT_EQ(centre("1 1 1 2 1 1 6 1 1\n"), (std::vector<double>{3, 3, 3}));
    EXPECT_EQ(centre("1 1 1 0 1 1 2 1 1\n"), (std::vector<double>{1.5, 1.5, 1.5}));  // 0: no data
    EXPECT_EQ(centre("0 1 1 0 1 1 0 1 1\n"), (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(centre("0.1 1 1 0.1 1 1 0.1 1 1\n"), (std::vector<double>{0.1, 0.1, 0.1}));
    for (const double f : centre("1.7e308 1 1 1.6e308 1 1 1.7e308 1 1\n")) {
        EXPECT_NEAR(f / 1e308, 5.0 / 3, 1e-15);  // no overflow; a few roundings
    }
}

TEST(Zemax, LeavesTheRowsAloneWithoutRadialZero) {
    const std::string text = replaced(smallZemax(), "0\t20\t40", "1\t20\t40");
    const SpecularTable table = parsed(replaced(text, "0.5\t0.4", "0.7\t0.4"));
    EXPECT_EQ(table.planes[0].f[0], 0.7);
    EXPECT_EQ(table.planes[0].f[3], 0.5);
}

TEST(Zemax, KeepsXyzAsThreePlanes) {
    const std::string mono = replaced(smallZemax(), "Content  Monochrome", "Content  XYZ");
    const std::size_t start = mono.find("Monochrome\n");
    const std::string header = mono.substr(0, start);
    const std::string data = mono.substr(start + 11);
    const std::string x = "TristimulusX\n" + data;
    const std::string y = "TristimulusY\n" + replaced(data, "TIS  0.25", "TIS  0.5");
    const std::string z = "\n\ntristimulusz\n" + replaced(data, "0.4\t0.1", "0.4\t0.9");
    const SpecularTable table = parsed(header + x + y + z);
    EXPECT_EQ(table.colour, TableColour::Xyz);
    ASSERT_EQ(table.planes.size(), 3U);
    EXPECT_EQ(table.planes[1].tis[0], 0.5);
    EXPECT_EQ(table.planes[2].f[2], 0.9);
    const std::string once = writeZemax(table).bytes;
    expectSame(parsed(once), table);
    EXPECT_EQ(writeZemax(parsed(once)).bytes, once);
    EXPECT_TRUE(refuses(parseZemax(header + x + z + y, "in"), {"'tristimulusz'", "TristimulusY"}));
    EXPECT_TRUE(refuses(parseZemax(header + x + y, "in"), {"the text ends", "TristimulusZ"}));
    EXPECT_TRUE(refuses(parseZemax(header + data, "in"), {"line "}));
}

TEST(Zemax, WritesATotalThatIsNotKnownAsWhatTheValuesAddUpTo) {
    SpecularTable table = parsed(smallZemax());
    table.planes[0].tis[1] = kNan;
    const Written written = writeZemax(table);
    EXPECT_TRUE(written.loss.items.empty());
    const double sum = specularIntegral(table, 0, {.incidence = 1});
    EXPECT_GT(sum, 0);
    EXPECT_EQ(parsed(written.bytes).planes[0].tis[0], table.planes[0].tis[0]);
    EXPECT_EQ(parsed(written.bytes).planes[0].tis[1], sum);
}

TEST(Zemax, WritesWhatIsNotFiniteAsZeroAndCountsIt) {
    SpecularTable table = parsed(smallZemax());
    table.planes[0].f[1] = kNan;
    table.planes[0].f[2] = -kInf;
    table.planes[0].tis[0] = kNan;
    const Written written = writeZemax(table);
    EXPECT_EQ(written.loss.items,
              (std::vector<LossReport::Item>{
                  {Loss::Masked, "nodes without a finite value, written as 0", 2},
                  {Loss::Dropped, "TIS without a finite value, written as 0", 1}}));
    const SpecularTable back = parsed(written.bytes);
    EXPECT_FALSE(back.hasData(0, {0, 0, 0, 1}));
    EXPECT_FALSE(back.hasData(0, {0, 0, 0, 2}));
    EXPECT_TRUE(back.hasData(0, {0, 0, 1, 1}));
    EXPECT_EQ(back.planes[0].tis[0], 0);  // the sum is no number either
}

TEST(Zemax, NamesTheFileThatItCannotRead) {
    const test::TempFolder folder;
    EXPECT_TRUE(refuses(readZemax(folder / "none.bsdf"), {"none.bsdf", "no such file"}));
    EXPECT_TRUE(refuses(readZemax(folder.path()), {folder.path().string()}));
    ASSERT_TRUE(writeFile(folder / "bad.bsdf", "\x01\xffz\n"));
    EXPECT_TRUE(refuses(readZemax(folder / "bad.bsdf"), {"bad.bsdf: line 1", "'?\?z'"}));
    ASSERT_TRUE(writeFile(folder / "good.bsdf", smallZemax()));
    EXPECT_TRUE(readZemax(folder / "good.bsdf"));
}

TEST(Zemax, PutsTheWavelengthIntoAComment) {
    EXPECT_EQ(wavelengthComment(630), "Wavelength (nm) = 630");
    EXPECT_EQ(wavelengthComment(525), "Wavelength (nm) = 525");
    EXPECT_EQ(wavelengthComment(465), "Wavelength (nm) = 465");
}

}  // namespace
}  // namespace gonio::proc
