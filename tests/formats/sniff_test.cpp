#include "proc/formats/sniff.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "proc/formats/alta.h"
#include "proc/formats/astm.h"
#include "proc/formats/bird.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/open.h"
#include "proc/formats/pab.h"
#include "proc/formats/scattered_csv.h"
#include "proc/table/specular_lookup.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/data_file.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

using test::dataFile;
using test::refuses;
using test::replaced;

const std::string kRgl("tensor_file\0\1\0", 14);
const std::string kLightTools =
    "# a comment\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterAzimuth 2\n0 180\n"
    "ScatterRadial 2\n0 90\nDataBegin\nAOI 10\nPOI 0\nSide Front\nWavelength 550\nTIS 0.1\n";

const std::vector<std::string> kNames{"a", "a.txt", "a.bsdf", "a.gonio", "a.graw", "a.csv", ""};

std::optional<Format> told(std::string_view text, const std::filesystem::path& path) {
    return sniff(text, text.size(), path);
}

TEST(Sniff, BelievesTheContentWhateverTheName) {
    const std::string sample = *encodeGonio(test::smallSample());
    const std::string raw = *encodeGraw(test::smallCapture());
    for (const std::string& name : kNames) {
        EXPECT_EQ(told(sample, name), Format::Gonio);
        EXPECT_EQ(told(raw, name), Format::Graw);
        EXPECT_EQ(told(test::smallZemax(), name), Format::Zemax);
        EXPECT_EQ(told(test::smallPoints(), name), Format::Csv);
        EXPECT_EQ(told("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", name), Format::Csv);
        EXPECT_EQ(told(kLightTools, name), Format::LightTools);
        EXPECT_EQ(told(kRgl, name), Format::Rgl);
    }
}

TEST(Sniff, AsksTheNameLast) {
    const std::vector<std::optional<Format>> kinds{std::nullopt,
                                                   std::nullopt,
                                                   Format::Zemax,
                                                   Format::Gonio,
                                                   Format::Graw,
                                                   Format::Csv,
                                                   std::nullopt};
    for (const char* head :
         {"", "banana", "theta", "AOI and side by side", "notAngleOfIncidence 3"}) {
        for (std::size_t i = 0; i < kNames.size(); ++i) EXPECT_EQ(told(head, kNames[i]), kinds[i]);
    }
    EXPECT_EQ(told("", "A.BSDF"), Format::Zemax);
    EXPECT_EQ(told("", "folder.csv/a"), std::nullopt);
}

TEST(Sniff, KnowsZemaxWithAnyCaseIndentAndLineEnd) {
    for (const char* before : {"", "\n", "\r", "\r\n", "  \t", "# x\n \t", "\n\n"}) {
        for (const char* word : {"AngleOfIncidence", "ANGLEOFINCIDENCE", "angleofincidence"}) {
            for (const char* after : {"", " 4", "\t4", "\r4", "\n"}) {
                EXPECT_EQ(told(std::string(before) + word + after, "a"), Format::Zemax);
            }
        }
    }
    EXPECT_EQ(told("# AngleOfIncidence 4", "a"), std::nullopt);
    EXPECT_EQ(told("AngleOfIncidences 4", "a"), std::nullopt);
}

TEST(Sniff, KnowsCsvBehindAByteOrderMark) {
    EXPECT_EQ(told("\xEF\xBB\xBFtheta_i,phi_i,theta_o,phi_o", "a"), Format::Csv);
}

TEST(Sniff, TakesTheWordOfTheNameForAnExrWhoseSchemaIsOutOfSight) {
    SampleSet set = test::smallSample();
    set.info.budgetJson = std::string(100'000, ' ');
    const test::TempFolder folder;
    ASSERT_TRUE(writeGonio(folder / "a.gonio", set));
    ASSERT_TRUE(writeGonio(folder / "a.exr", set));
    EXPECT_EQ(*sniffFile(folder / "a.gonio"), Format::Gonio);
    EXPECT_TRUE(refuses(sniffFile(folder / "a.exr"), {"a.exr", "OpenEXR picture without one"}));
}

TEST(Sniff, KnowsPicturesThatHoldNoBrdf) {
    for (const char* name :
         {"AllHalfValues", "BrightRings", "MirrorPattern", "Rec709", "t06", "XYZ"}) {
        const auto file = dataFile("exr_edge_cases/" + std::string(name) + ".exr");
        if (!file) continue;
        EXPECT_TRUE(refuses(sniffFile(*file), {"OpenEXR picture without one"})) << name;
    }
}

TEST(Sniff, KnowsRealFilesOfEachFormat) {
    const std::pair<const char*, Format> files[] = {
        {"vendor_exports/test_lighttools.txt", Format::LightTools},
        {"vendor_exports/test_jdv.jdv", Format::Rt300s},
        {"vendor_exports/R_test.anisotropicbsdf", Format::Speos},
        {"vendor_exports/L100_2.simplescattering", Format::Speos},
        {"gonio_rt300s/blank_v2o0_20250911.RT.csv", Format::Rt300s},
        {"gonio_rt300s/aeroglaze.bsdf", Format::Zemax},
        {"gonio_rt300s/AnoBlackEC1onAlum.bsdf", Format::Zemax},
        {"klems_xml/2011-SA1.XML", Format::Klems},
        {"retroreflective/retro-3M-jaune.dat", Format::Alta}};
    for (const auto& [name, format] : files) {
        const auto file = dataFile(name);
        if (!file) continue;
        const auto found = sniffFile(*file);
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_EQ(*found, format) << name;
    }
}

TEST(Sniff, KnowsTheFirstWordsOfEachFormatWhateverTheName) {
    const std::pair<std::string, Format> heads[] = {
        {"NVIDIA ARC MBSDF V1\n", Format::Mbsdf},
        {"OPTIS - Anisotropic BSDF surface file v8.0\n0\n", Format::Speos},
        {" \r\n{\"metadata\": {", Format::Bird},
        {"\xEF\xBB\xBF{\"data\": {", Format::Bird},
        {"# SSDD\nVERSION 0.3\nDATA_TYPE brdf\n", Format::Ssdd},
        {"#DIM 3 1\n#PARAM_IN COS_TH\n", Format::Alta},
        {"#sample_name \"a\"\n#format: theta phi BSDF\n", Format::Pab},
        {"NUM_POINTS 3\nVARS theta_i,phi_i,theta_s,phi_s,R,G,B\n", Format::Astm},
        {"azimuth_deg,incidence_deg,receive_deg,RT\n", Format::Rt300s},
        {"<?xml version=\"1.0\"?>\n<WindowElement xmlns=", Format::Klems}};
    for (const auto& [head, format] : heads) {
        for (const std::string& name : kNames) EXPECT_EQ(told(head, name), format) << head;
    }
}

TEST(Sniff, KnowsTablesWithoutAHeaderByTheirSize) {
    constexpr std::uintmax_t kMerl = 34'992'012;
    const std::string dims("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12);
    EXPECT_EQ(sniff(dims, kMerl, "a"), Format::Merl);
    EXPECT_EQ(sniff(dims, kMerl - 1, "a"), std::nullopt);
    const std::string huge("\xff\xff\xff\x7f\xff\xff\xff\x7f\xff\xff\xff\x7f", 12);
    EXPECT_EQ(sniff(huge, kMerl, "a"), std::nullopt);
    EXPECT_EQ(sniff(std::string(64, '\0'), 1'990'656, "a"), Format::Utia);
    EXPECT_EQ(sniff(std::string(64, '\0'), 1'990'655, "a"), std::nullopt);
}

TEST(Format, HasANameThatReadsBack) {
    std::set<std::string_view> names;
    for (const FormatFacts& facts : formats()) {
        EXPECT_EQ(&factsOf(facts.format), &facts);
        EXPECT_EQ(*parseFormat(facts.name), facts.format);
        names.insert(facts.name);
    }
    EXPECT_EQ(names.size(), kFormatCount);
    EXPECT_EQ(parseFormat("banana").error().kind, ErrorKind::Usage);
}

TEST(Format, IsWrittenAsTheNameSaysOrAsksWhich) {
    EXPECT_EQ(*formatToWrite("a.bsdf"), Format::Zemax);
    EXPECT_EQ(*formatToWrite("a.b.JSON"), Format::Bird);
    for (const FormatFacts& facts : formats()) {
        const auto found = formatToWrite("a" + std::string(facts.extension));
        const bool several = facts.format == Format::Speos;  // .brdf, which BiRD's files have, too
        EXPECT_EQ(bool(found), !several && (facts.writes || facts.format == Format::Rt300s))
            << facts.name;
    }
    const auto both = formatToWrite("a.brdf");
    ASSERT_FALSE(both);
    EXPECT_EQ(both.error().kind, ErrorKind::Usage);
    EXPECT_NE(both.error().message.find("--to with one of bird, speos"), std::string::npos);
    EXPECT_NE(formatToWrite("a.xml").error().message.find("only read"), std::string::npos);
    EXPECT_NE(formatToWrite("a").error().message.find("tells no format"), std::string::npos);
}

TEST(Sniff, NamesTheFileThatItCannotRead) {
    const test::TempFolder folder;
    EXPECT_TRUE(refuses(sniffFile(folder / "none.bsdf"), {"none.bsdf: no such file"}));
    EXPECT_TRUE(refuses(sniffFile(folder.path()), {"not a file"}));
}

TEST(OpenBrdf, AnswersFromAZemaxFileAtItsNodes) {
    const auto opened = openBrdf(std::filesystem::path(GONIO_SOURCE_DIR) / "config" / "demo" /
                                 "AnoBlackEC1onAlum.bsdf");
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ((*opened)->bandCount(), BandCount::One);
    const auto* lookup = dynamic_cast<const SpecularLookup*>(opened->get());
    ASSERT_NE(lookup, nullptr);
    const LightView pair = lookup->table().pairAt({0, 1, 9, 4});
    const Answer answer = (*opened)->answer(pair);
    EXPECT_TRUE(answer.present());
    EXPECT_EQ(answer.source, Source::Measured);
    EXPECT_EQ(answer.f[Band::G], lookup->table().planes[0].f[lookup->table().index({0, 1, 9, 4})]);
    // Plane symmetry: the same on the other side of the plane of incidence, to rounding.
    const auto& v = pair.out.vector();
    const LightView mirrored{pair.in, *Direction::fromVector({v.x(), -v.y(), v.z()})};
    EXPECT_NEAR((*opened)->answer(mirrored).f[Band::G], answer.f[Band::G], 1e-12);
}

TEST(OpenBrdf, AnswersFromASampleWhateverItsName) {
    const test::TempFolder folder;
    SampleSet set = test::sampleSet([](Radians, const Direction&) { return 0.25; });
    ASSERT_TRUE(writeGonio(folder / "sample.exr", set));
    const auto opened = openBrdf(folder / "sample.exr");
    ASSERT_TRUE(opened) << opened.error().message;
    const Answer answer = (*opened)->answer(
        {Direction::fromSpherical(20_deg, 0_deg), Direction::fromSpherical(30_deg, 90_deg)});
    EXPECT_EQ((*opened)->bandCount(), BandCount::Three);
    EXPECT_EQ(answer.f[Band::R], 0.25);
    EXPECT_EQ(answer.f[Band::B], 0.75);
}

TEST(OpenBrdf, NamesTheKindOfWhatItCannotAnswerFrom) {
    const test::TempFolder folder;
    const auto refused =
        [&](const std::string& name, std::string_view bytes, std::string_view kind) {
            EXPECT_TRUE(writeFile(folder / name, bytes));
            return refuses(openBrdf(folder / name), {name, kind});
        };
    EXPECT_TRUE(refused("d.graw", *encodeGraw(test::smallCapture()), "gonio raw capture"));
    EXPECT_TRUE(refused("e.exr", "\x76\x2f\x31\x01", "OpenEXR picture"));
    EXPECT_TRUE(refused("f.txt", "banana", "unknown format"));
    EXPECT_TRUE(refused("g", "", "unknown format"));
}

TEST(OpenBrdf, NamesTheFileThatIsDamagedOrHasNoFOfTheBands) {
    const test::TempFolder folder;
    EXPECT_TRUE(refuses(openBrdf(folder / "none.bsdf"), {"none.bsdf: no such file"}));
    EXPECT_TRUE(refuses(openBrdf(folder.path()), {"not a file"}));
    ASSERT_TRUE(writeFile(folder / "cut.bsdf", test::smallZemax().substr(0, 300)));
    EXPECT_TRUE(refuses(openBrdf(folder / "cut.bsdf"), {"zemax: ", "cut.bsdf: line "}));
    ASSERT_TRUE(writeFile(folder / "cut.gonio", encodeGonio(test::smallSample())->substr(0, 3000)));
    EXPECT_TRUE(refuses(openBrdf(folder / "cut.gonio"), {"gonio: ", "cut.gonio: exr: "}));
}

/// Any of these words once made its file another format's, wherever it stood.
TEST(Sniff, IsNotMisledByNamesAndComments) {
    BrdfRows rows;
    rows.channels = {Channel{}};
    const Direction up = Direction::fromSpherical({}, {});
    rows.pairs = {{.in = up, .out = up}};
    rows.f = {0.5};
    for (const std::string word : {"RT-300S",
                                   "#format: theta phi BSDF",
                                   "Intensity BRDF",
                                   "Data file type : Intensity BRDF",
                                   "DataType: BRDF(RT-300S)",
                                   "azimuth_deg,incidence_deg,receive_deg,RT",
                                   "theta_i,phi_i,theta_o,phi_o,f",
                                   "wi_x",
                                   "<WindowElement xmlns=",
                                   "VARS theta_i,phi_i",
                                   "#DIM 3 1",
                                   "AngleOfIncidence 4",
                                   "DATA_TYPE brdf"}) {
        Metadata about;
        about.set(key::kRig, word);
        about.set(key::kNotes, "first\n" + word);
        about.comments = {word};
        EXPECT_EQ(told(writeScatteredCsv(rows, about).bytes, "a"), Format::Csv) << word;
        EXPECT_EQ(told(writeAstm(rows, about)->bytes, "a"), Format::Astm) << word;
        EXPECT_EQ(told(writeAlta(rows, about)->bytes, "a"), Format::Alta) << word;
        EXPECT_EQ(told(writePab(rows, about)->files.front().bytes, "a"), Format::Pab) << word;
        EXPECT_EQ(told(writeBird(rows, about)->bytes, "a"), Format::Bird) << word;
        EXPECT_EQ(told("# " + word + "\n" + test::smallZemax(), "a"), Format::Zemax) << word;
        EXPECT_EQ(told("# " + word + "\n" + kLightTools, "a"), Format::LightTools) << word;
    }
}

TEST(Sniff, KnowsTheExportsOfAnRt300sByTheirHeaders) {
    const std::string stil = "Name / Comment :\ttheta_i\rData file type :\tBRDF\t\r";
    EXPECT_EQ(told(stil, "a"), Format::LightTools);
    EXPECT_EQ(told("\xEF\xBB\xBF" + stil, "a"), Format::LightTools);
    EXPECT_EQ(told("DataType:\tBRDF(RT-300S)\t\rSampleID:\tx\r", "a"), Format::Rt300s);
    EXPECT_EQ(told("DataType:\tBTDF\rSampleID:\tRT-300S\r", "a"), std::nullopt);
    EXPECT_EQ(told("# black\r\nreceive_deg,azimuth_deg,incidence_deg,RT\r\n", "a"), Format::Rt300s);
}

}  // namespace
}  // namespace gonio::proc
