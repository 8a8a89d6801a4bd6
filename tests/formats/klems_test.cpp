#include "proc/formats/klems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proc/formats/file_bytes.h"
#include "proc/table/klems_lookup.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/data_file.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;

/// A basis of one cap and a ring of two patches; the numbers are on lines 24..26.
std::string small() {
    return "<?xml version=\"1.0\"?>\n"
           "<WindowElement xmlns=\"http://windows.lbl.gov\">\n"
           "<Optical><Layer>\n"
           "<Material><Name> a shade </Name><Manufacturer>b</Manufacturer>\n"
           "<Thickness unit=\"Millimeter\">1</Thickness></Material>\n"
           "<DataDefinition>\n"
           "<IncidentDataStructure>Columns</IncidentDataStructure>\n"
           "<AngleBasis><AngleBasisName>own</AngleBasisName>\n"
           "<AngleBasisBlock><Theta>0</Theta>\n"
           "<ThetaBounds><LowerTheta>0</LowerTheta><UpperTheta>30</UpperTheta></ThetaBounds>\n"
           "<nPhis>1</nPhis></AngleBasisBlock>\n"
           "<AngleBasisBlock><Theta>60</Theta>\n"
           "<ThetaBounds><LowerTheta>30</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds>\n"
           "<nPhis>2</nPhis></AngleBasisBlock>\n"
           "</AngleBasis></DataDefinition>\n"
           "<WavelengthData>\n"
           "<Wavelength unit=\"Integral\">Visible</Wavelength>\n"
           "<WavelengthDataBlock>\n"
           "<WavelengthDataDirection>Reflection Front</WavelengthDataDirection>\n"
           "<ColumnAngleBasis>own</ColumnAngleBasis>\n"
           "<RowAngleBasis>own</RowAngleBasis>\n"
           "<ScatteringDataType>BTDF</ScatteringDataType>\n"
           "<ScatteringData>\n"
           "0.01, 0.02, 0.03,\n"
           "0.04, 0.05, 0.06,\n"
           "0.07, 0.08, 0.09\n"
           "</ScatteringData></WavelengthDataBlock></WavelengthData>\n"
           "</Layer></Optical></WindowElement>\n";
}

FileRead<KlemsTable> parsed(std::string_view text) {
    auto read = parseKlems(text, "in.xml");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(*read) : FileRead<KlemsTable>{.content = {}, .about = {}};
}

TEST(KlemsReader, PutsEachNumberInItsPlace) {
    const auto read = parsed(small());
    const KlemsTable& table = read.content;
    ASSERT_EQ(table.matrices.size(), 1U);
    EXPECT_EQ(table.bases[0].rings, (std::vector<KlemsBasis::Ring>{{30, 1}, {90, 2}}));
    EXPECT_EQ(table.at(table.matrices[0], 2, 0), 0.03);
    EXPECT_EQ(table.at(table.matrices[0], 0, 2), 0.07);
    EXPECT_EQ(read.about.at(key::kSample), "a shade");
    EXPECT_EQ(read.about.at("thickness"), "1 Millimeter");
    EXPECT_TRUE(read.warnings.empty());
    const KlemsTable rows =
        parsed(replaced(small(), "<IncidentDataStructure>Columns", "<IncidentDataStructure>Rows"))
            .content;
    EXPECT_EQ(rows.at(rows.matrices[0], 0, 2), 0.03);
}

TEST(KlemsReader, KnowsTheCommonBases) {
    std::string text =
        replaced(small(), "<ColumnAngleBasis>own", "<ColumnAngleBasis>LBNL/Klems Quarter");
    EXPECT_TRUE(refuses(parseKlems(text, "in"), {"wanted 3 x 41"}));
    text = replaced(small(), "<RowAngleBasis>own", "<RowAngleBasis>other");
    EXPECT_TRUE(refuses(parseKlems(text, "in"), {"line 18", "RowAngleBasis 'other' is not known"}));
}

TEST(KlemsReader, TakesAnyLineEndAndByteOrderMark) {
    for (const char* end : {"\r\n", "\r"}) {
        std::string text;
        for (const char c : small()) text += c == '\n' ? std::string(end) : std::string(1, c);
        EXPECT_EQ(parsed(text).content.matrices[0].f, parsed(small()).content.matrices[0].f);
    }
    EXPECT_EQ(parsed("\xEF\xBB\xBF" + small()).content.matrices.size(), 1U);
}

TEST(KlemsReader, RefusesATextCutAnywhere) {
    const std::string text = small();
    for (std::size_t size = 0; size + 1 < text.size(); ++size) {
        EXPECT_TRUE(refuses(parseKlems(text.substr(0, size), "cut"), {"klems: cut: line "}))
            << size;
    }
}

TEST(KlemsReader, RefusesWhatIsNoFiniteNumber) {
    for (const char* word : {"banana", "nan", "inf", "1e999", "0x10"}) {
        EXPECT_TRUE(refuses(parseKlems(replaced(small(), "0.05", word), "in"),
                            {"klems: in: line 25: ", word, "is not a finite number"}));
        EXPECT_TRUE(refuses(
            parseKlems(replaced(small(), "<UpperTheta>30", std::string("<UpperTheta>") + word),
                       "in"),
            {"line 10", word}));
    }
    EXPECT_TRUE(
        refuses(parseKlems(replaced(small(), "0.05", "0,05"), "in"), {"more than 9 values"}));
    EXPECT_TRUE(refuses(parseKlems(replaced(small(), "0.05,", ""), "in"),
                        {"line 23", "8 values, wanted 3 x 3"}));
}

TEST(KlemsReader, RefusesWhatDoesNotFit) {
    const auto wrong = [](std::string_view from, std::string_view to) {
        return parseKlems(replaced(small(), from, to), "in");
    };
    EXPECT_TRUE(refuses(parseKlems("", "in"), {"no XML"}));
    EXPECT_TRUE(refuses(parseKlems("<a/>", "in"), {"wanted <WindowElement>"}));
    EXPECT_TRUE(refuses(parseKlems(small() + "<", "in"), {"no XML"}));
    EXPECT_TRUE(refuses(wrong("Columns", "TensorTree4"), {"'TensorTree4' is not read"}));
    EXPECT_TRUE(refuses(wrong("<nPhis>2", "<nPhis>1000000000"), {"line 12", "'1000000000'"}));
    EXPECT_TRUE(refuses(wrong("<nPhis>2", "<nPhis>20000"), {"'20000'"}));
    EXPECT_TRUE(refuses(wrong("<nPhis>2", "<nPhis>10000"), {"wanted 10001 x 10001"}));
    EXPECT_TRUE(refuses(wrong("<nPhis>2", "<nPhis>0"), {"'0'"}));
    EXPECT_TRUE(refuses(wrong("<LowerTheta>30", "<LowerTheta>40"), {"gapless"}));
    EXPECT_TRUE(refuses(wrong("<UpperTheta>90", "<UpperTheta>91"), {"gapless"}));
    EXPECT_TRUE(refuses(wrong("Reflection Front", "Front"), {"'Front', wanted"}));
    EXPECT_TRUE(refuses(wrong("<Layer>", "<Lay>"), {"no XML"}));
    const std::string block =
        small().substr(small().find("<WavelengthData>"),
                       small().find("</Layer>") - small().find("<WavelengthData>"));
    EXPECT_TRUE(refuses(parseKlems(replaced(small(), "</Layer>", block + "</Layer>"), "in"),
                        {"a second matrix"}));
    EXPECT_TRUE(
        refuses(parseKlems(replaced(small(), block, ""), "in"), {"no <WavelengthDataBlock>"}));
}

TEST(KlemsReader, DoesNotExpandEntities) {
    const std::string bomb =
        "<!DOCTYPE a [<!ENTITY b \"0.5 0.5\"><!ENTITY c \"&b;&b;&b;\">]>" + small().substr(22);
    EXPECT_TRUE(
        refuses(parseKlems(replaced(bomb, "0.05", "&c;"), "in"), {"'&c;' is not a finite"}));
}

TEST(KlemsReader, WarnsOfNegativeAndTooBrightMatrices) {
    EXPECT_EQ(parsed(replaced(small(), "0.05", "-0.05")).warnings,
              std::vector<std::string>{"1 negative values"});
    EXPECT_EQ(parsed(replaced(small(), "0.05", "5")).warnings,
              std::vector<std::string>{"1 incident patches scatter more than falls on them"});
}

TEST(KlemsReader, ReadsTheShadeFabric) {
    const auto file = test::dataFile("klems_xml/2011-SA1.XML");
    if (!file) return;
    const auto bytes = readFile(*file);
    ASSERT_TRUE(bytes);
    const auto read = parsed(*bytes);
    const KlemsTable& table = read.content;
    EXPECT_EQ(read.about.at(key::kSample), "Satine 5500 5%, White Pearl");
    EXPECT_TRUE(read.warnings.empty());
    ASSERT_EQ(table.matrices.size(), 8U);
    EXPECT_EQ(table.bases, std::vector<KlemsBasis>{*knownKlemsBasis("LBNL/Klems Full")});
    const KlemsMatrix* front = table.find(KlemsFace::Front, false, "Visible");
    ASSERT_NE(front, nullptr);
    const auto [least, most] = std::minmax_element(front->f.begin(), front->f.end());
    EXPECT_EQ(*least, 0.153571);
    EXPECT_EQ(*most, 0.204156);
    // The columns are the light: its total grows toward grazing, where over the rows it would not.
    EXPECT_NEAR(table.hemispherical(*front).front(), 0.4825, 1e-4);
    EXPECT_NEAR(table.hemispherical(*front).back(), 0.6414, 1e-4);
    const KlemsMatrix* through = table.find(KlemsFace::Front, true, "Visible");
    ASSERT_NE(through, nullptr);
    EXPECT_NEAR(table.hemispherical(*through).front(), 0.0959, 1e-4);
    // Straight through the weave: the diagonal.
    EXPECT_EQ(table.at(*through, 0, 0), 2.063833);
    EXPECT_EQ(table.at(*through, 5, 5), 2.027935);
    EXPECT_EQ(table.at(*through, 5, 6), 0.014938);
    const auto lookup = KlemsLookup::over(table, {});
    ASSERT_TRUE(lookup);
    const Direction wi = Direction::fromSpherical(40_deg, 15_deg);
    EXPECT_GT(lookup->answer({.in = wi, .out = *Direction::fromVector(-wi.vector())}).f[Band::G],
              1);
    EXPECT_LT(lookup->answer({.in = wi, .out = mirrorOf(wi)}).f[Band::G], 0.21);
}

}  // namespace
}  // namespace gonio::proc
