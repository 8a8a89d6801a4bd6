#include "proc/formats/sniff.h"

#include <gtest/gtest.h>

#include <set>

#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/open.h"
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

TEST(Sniff, BelievesTheContentWhateverTheName) {
    const std::string sample = *encodeGonio(test::smallSample());
    const std::string raw = *encodeGraw(test::smallCapture());
    for (const std::string& name : kNames) {
        EXPECT_EQ(sniff(sample, name), FileKind::Gonio);
        EXPECT_EQ(sniff(raw, name), FileKind::Graw);
        EXPECT_EQ(sniff(test::smallZemax(), name), FileKind::Zemax);
        EXPECT_EQ(sniff(test::smallPoints(), name), FileKind::PointsCsv);
        EXPECT_EQ(sniff("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", name), FileKind::PointsCsv);
        EXPECT_EQ(sniff(kLightTools, name), FileKind::LightTools);
        EXPECT_EQ(sniff(kRgl, name), FileKind::Rgl);
    }
}

TEST(Sniff, AsksTheNameLast) {
    const std::vector<FileKind> kinds{FileKind::Unknown,
                                      FileKind::Unknown,
                                      FileKind::Zemax,
                                      FileKind::Gonio,
                                      FileKind::Graw,
                                      FileKind::PointsCsv,
                                      FileKind::Unknown};
    for (const char* head :
         {"", "banana", "theta", "AOI and side by side", "notAngleOfIncidence 3"}) {
        for (std::size_t i = 0; i < kNames.size(); ++i) EXPECT_EQ(sniff(head, kNames[i]), kinds[i]);
    }
    EXPECT_EQ(sniff("", "A.BSDF"), FileKind::Zemax);
    EXPECT_EQ(sniff("", "folder.csv/a"), FileKind::Unknown);
}

TEST(Sniff, KnowsZemaxWithAnyCaseIndentAndLineEnd) {
    for (const char* before : {"", "\n", "\r", "\r\n", "  \t", "# x\n \t", "\n\n"}) {
        for (const char* word : {"AngleOfIncidence", "ANGLEOFINCIDENCE", "angleofincidence"}) {
            for (const char* after : {"", " 4", "\t4", "\r4", "\n"}) {
                EXPECT_EQ(sniff(std::string(before) + word + after, "a"), FileKind::Zemax);
            }
        }
    }
    EXPECT_EQ(sniff("# AngleOfIncidence 4", "a"), FileKind::Unknown);
    EXPECT_EQ(sniff("AngleOfIncidences 4", "a"), FileKind::Unknown);
}

TEST(Sniff, KnowsCsvBehindAByteOrderMark) {
    EXPECT_EQ(sniff("\xEF\xBB\xBFtheta_i,phi_i,theta_o,phi_o", "a"), FileKind::PointsCsv);
}

TEST(Sniff, TakesTheWordOfTheNameForAnExrWhoseSchemaIsOutOfSight) {
    SampleSet set = test::smallSample();
    set.info.budgetJson = std::string(100'000, ' ');
    const test::TempFolder folder;
    ASSERT_TRUE(writeGonio(folder / "a.gonio", set));
    ASSERT_TRUE(writeGonio(folder / "a.exr", set));
    EXPECT_EQ(*sniffFile(folder / "a.gonio"), FileKind::Gonio);
    EXPECT_EQ(*sniffFile(folder / "a.exr"), FileKind::OtherExr);
}

TEST(Sniff, KnowsOtherPicturesAndNoVendorsExport) {
    for (const char* name :
         {"AllHalfValues", "BrightRings", "MirrorPattern", "Rec709", "t06", "XYZ"}) {
        const auto file = dataFile("exr_edge_cases/" + std::string(name) + ".exr");
        if (!file) continue;
        EXPECT_EQ(*sniffFile(*file), FileKind::OtherExr) << name;
    }
    for (const char* name : {"test_lighttools.txt",
                             "test_jdv.jdv",
                             "R_test.anisotropicbsdf",
                             "L100_2.simplescattering"}) {
        const auto file = dataFile("vendor_exports/" + std::string(name));
        if (!file) continue;
        EXPECT_EQ(*sniffFile(*file), FileKind::Unknown) << name;
    }
}

TEST(Sniff, NamesEveryKindDifferently) {
    std::set<std::string_view> names;
    for (int kind = 0; kind <= static_cast<int>(FileKind::Unknown); ++kind) {
        names.insert(name(static_cast<FileKind>(kind)));
    }
    EXPECT_EQ(names.size(), static_cast<std::size_t>(FileKind::Unknown) + 1);
    EXPECT_EQ(name(FileKind::Zemax), "Zemax BSDF");
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
    const auto refused = [&](const std::string& name,
                             std::string_view bytes,
                             std::string_view kind) {
        EXPECT_TRUE(writeFile(folder / name, bytes));
        return refuses(openBrdf(folder / name), {"read ", name, kind, "cannot be read as a BRDF"});
    };
    EXPECT_TRUE(refused("a.bsdf", kLightTools, "LightTools BSDF"));
    EXPECT_TRUE(refused("b.bsdf", kRgl, "RGL tensor file"));
    EXPECT_TRUE(refused("c.csv", test::smallPoints(), "CSV of directions"));
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
    ASSERT_TRUE(writeFile(folder / "btdf.bsdf", replaced(test::smallZemax(), "BRDF", "BTDF")));
    EXPECT_TRUE(refuses(openBrdf(folder / "btdf.bsdf"), {"btdf.bsdf", "BTDF"}));
    ASSERT_TRUE(writeFile(folder / "cut.gonio", encodeGonio(test::smallSample())->substr(0, 3000)));
    EXPECT_TRUE(refuses(openBrdf(folder / "cut.gonio"), {"gonio: ", "cut.gonio: exr: "}));
}

}  // namespace
}  // namespace gonio::proc
