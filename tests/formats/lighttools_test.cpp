#include "proc/formats/lighttools.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/formats/spherical_files.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;
using test::SphericalShape;
using test::sphericalTable;
using test::steps;

FileRead<SphericalTable> parsed(std::string_view text,
                                VendorExtrapolation beyond = VendorExtrapolation::Masked) {
    auto read = parseLightTools(text, "in.bsdf", beyond);
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(*read) : FileRead<SphericalTable>{.content = {}, .about = {}};
}

/// Two blocks on 3 azimuths x 2 radials; the numbers are on lines 12..14 and 21..23.
std::string small() {
    return "# sample: a\n"
           "Symmetry  PlaneSymmetrical\n"
           "SpectralContent  Monochrome\n"
           "ScatterAzimuth  3\n"
           "90\t180\t270\n"
           "ScatterRadial  2\n"
           "0\t60\n"
           "DataBegin\n"
           "AOI  20\nPOI  0\nSide  Front\nWavelength  525\nScatterType  BRDF\nTIS  0.3\n"
           "0.1\t0.2\n0.1\t0.3\n0.1\t0.4\n"
           "AOI  20\nPOI  0\nSide  Front\nWavelength  525\nScatterType  BTDF\nTIS  0.1\n"
           "0.5\t0.6\n0.5\t0.7\n0.5\t0.8\n"
           "DataEnd\n";
}

/// The MiniDiff layout with f = 1 everywhere.
std::string miniDiffLike(std::size_t incidences = 4) {
    SphericalTable table;
    table.channels = Channel::ofBands();
    table.mirrorAzimuthDeg = kLightToolsMirrorDeg;
    for (const bool transmission : {false, true}) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            for (std::size_t i = 0; i < incidences; ++i) {
                SphericalBlock block{
                    .channel = channel,
                    .incidenceDeg = 20.0 * static_cast<double>(i),
                    .transmission = transmission,
                    .azimuthDeg = steps(0, 360, 1),
                    .thetaDeg = transmission ? steps(90, 180, 1) : steps(0, 90, 1)};
                block.f.assign(std::size_t{361} * 91, 1);
                table.blocks.push_back(std::move(block));
            }
        }
    }
    return writeLightTools(table, {}).bytes;
}

TEST(LightToolsReader, PutsEachNumberInItsPlace) {
    const auto read = parsed(small());
    const SphericalTable& table = read.content;
    EXPECT_EQ(table.mirrorAzimuthDeg, 270);
    EXPECT_TRUE(table.planeSymmetrical);
    ASSERT_EQ(table.blocks.size(), 2U);
    EXPECT_EQ(table.channels, std::vector<Channel>{Channel::of(Band::G)});
    EXPECT_EQ(table.blocks[0].f, (std::vector<double>{0.1, 0.2, 0.1, 0.3, 0.1, 0.4}));
    EXPECT_EQ(table.blocks[0].tis, 0.3);
    EXPECT_EQ(table.blocks[0].incidenceDeg, 20);
    EXPECT_TRUE(table.blocks[1].transmission);
    EXPECT_EQ(table.blocks[1].thetaDeg, (std::vector<double>{120, 180}));
    EXPECT_EQ(table.blocks[1].f, (std::vector<double>{0.6, 0.5, 0.7, 0.5, 0.8, 0.5}));
    EXPECT_EQ(read.about.comments, std::vector<std::string>{"sample: a"});
    EXPECT_TRUE(read.warnings.empty());
    const LightView mirror = table.pairAt(table.blocks[0], 2, 1);
    EXPECT_NEAR(
        mirror.in.x() * mirror.out.x() + mirror.in.y() * mirror.out.y(),
        -std::sin(Radians::fromDegrees(20).value()) * std::sin(Radians::fromDegrees(60).value()),
        1e-12);
}

TEST(LightToolsReader, IsLenientAboutForm) {
    const std::string once = writeLightTools(parsed(small()).content, {}).bytes;
    std::string lowered = small();
    for (char& c : lowered) c = static_cast<char>(std::tolower(c));
    EXPECT_EQ(writeLightTools(parsed(lowered).content, {}).bytes, once);
    for (const char* end : {"\r\n", "\r", "\n\n", " \n"}) {
        std::string text;
        for (const char c : small()) text += c == '\n' ? std::string(end) : std::string(1, c);
        EXPECT_EQ(writeLightTools(parsed(text).content, {}).bytes, once);
    }
    EXPECT_EQ(writeLightTools(parsed("\xEF\xBB\xBF" + small()).content, {}).bytes, once);
    const std::string moved =
        replaced(small(), "AOI  20\nPOI  0\nSide  Front\n", "Side Front AOI 20\n");
    EXPECT_EQ(writeLightTools(parsed(moved).content, {}).bytes, once);
}

TEST(LightToolsReader, RefusesATextCutAnywhere) {
    const std::string text = small();
    for (std::size_t size = 0; size + 8 < text.size(); ++size) {
        EXPECT_TRUE(
            refuses(parseLightTools(text.substr(0, size), "cut"), {"lighttools: cut: line "}))
            << size;
    }
}

TEST(LightToolsReader, RejectsTruncatedBlock) {
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "0.1\t0.3\n", "0.1\n"), "in"),
                        {"line 18", "5 values in block, header promised 6"}));
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "0.1\t0.3\n", "0.1 0.3 1\n"), "in"),
                        {"more than 6 values in block, header promised 6"}));
}

TEST(LightToolsReader, RefusesWhatIsNoFiniteNumber) {
    for (const char* word : {"banana", "nan", "inf", "-inf", "1e999", "0x10", "0,3"}) {
        EXPECT_TRUE(refuses(
            parseLightTools(replaced(small(), "0.1\t0.3", std::string("0.1\t") + word), "in"),
            {"line 16", word, "is not a finite number"}));
        for (const char* keyword : {"AOI  20", "POI  0", "Wavelength  525", "TIS  0.3"}) {
            const std::string name(keyword, std::string_view(keyword).find(' '));
            EXPECT_TRUE(
                refuses(parseLightTools(replaced(small(), keyword, name + " " + word), "in"),
                        {word, name}));
        }
        EXPECT_TRUE(refuses(
            parseLightTools(replaced(small(), "90\t180", word + std::string("\t180")), "in"),
            {"line 5", word}));
    }
}

TEST(LightToolsReader, RefusesCountsThatTheTextCannotHold) {
    for (const char* keyword : {"ScatterAzimuth  3", "ScatterRadial  2"}) {
        const std::string name(keyword, std::string_view(keyword).find(' '));
        for (const char* count : {"1000000000", "9223372036854775807"}) {
            EXPECT_TRUE(
                refuses(parseLightTools(replaced(small(), keyword, name + " " + count), "in"),
                        {name, count, "bytes are left"}));
        }
        for (const char* count : {"0", "-1", "9223372036854775808", "1.5"}) {
            EXPECT_TRUE(
                refuses(parseLightTools(replaced(small(), keyword, name + " " + count), "in"),
                        {"the number of values of " + name}));
        }
    }
    std::string wide = "Symmetry Asymmetric SpectralContent Monochrome\n";
    for (const char* axis : {"ScatterAzimuth 3000", "ScatterRadial 3000"}) {
        wide += std::string(axis) + "\n";
        for (int i = 0; i < 3000; ++i) wide += std::to_string(0.01 * i) + " ";
    }
    EXPECT_TRUE(refuses(
        parseLightTools(wide + "DataBegin AOI 0 ScatterType BRDF TIS 0 1 1 1 DataEnd", "in"),
        {"3000 x 3000 values"}));
}

TEST(LightToolsReader, RefusesWhatItDoesNotKnowOrIsGivenTwice) {
    EXPECT_TRUE(refuses(parseLightTools("", "in"), {"the text ends, wanted Symmetry"}));
    EXPECT_TRUE(refuses(parseLightTools("Source Measured", "in"), {"unknown keyword 'Source'"}));
    EXPECT_TRUE(refuses(parseLightTools(small() + "more", "in"), {"'more', wanted nothing after"}));
    EXPECT_TRUE(refuses(
        parseLightTools(replaced(small(), "Symmetry", "SpectralContent XYZ\nSymmetry"), "in"),
        {"line 4", "'SpectralContent' is given twice"}));
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "POI  0", "AOI 20"), "in"),
                        {"'AOI' is given twice in one block"}));
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "BTDF", "BRDF"), "in"),
                        {"a second block of AOI 20"}));
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "AOI  20\n", ""), "in"), {"has no AOI"}));
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "ScatterType  BRDF\n", ""), "in"),
                        {"no ScatterType"}));
    EXPECT_TRUE(
        refuses(parseLightTools(replaced(small(), "AOI  20", "AOI 90"), "in"), {"grazing"}));
    EXPECT_TRUE(
        refuses(parseLightTools(replaced(small(), "AOI  20", "AOI 181"), "in"), {"[0, 180]"}));
    EXPECT_TRUE(
        refuses(parseLightTools(replaced(small(), "0\t60", "60\t0"), "in"), {"must ascend"}));
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "0\t60", "0\t91"), "in"), {"[0, 90]"}));
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "Monochrome", "XYZ"), "in"),
                        {"no TristimulusValue"}));
    EXPECT_TRUE(refuses(parseLightTools(replaced(small(), "Side  Front", "Side Left"), "in"),
                        {"'Left', wanted Side Front, Back"}));
}

TEST(LightToolsReader, KeepsLightFromBehindApart) {
    for (const char* behind : {"Back\nWavelength  525\nScatterType  BTDF", "AOI 160"}) {
        std::string text = small();
        const std::size_t second = text.find("AOI", text.find("0.4"));
        if (std::string_view(behind) == "AOI 160") {
            text.replace(second, 7, behind);
        } else {
            const std::size_t side = text.find("Front", second);
            text.replace(side, std::string_view("Front").size(), "Back");
        }
        const auto read = parsed(text);
        ASSERT_EQ(read.content.blocks.size(), 1U);
        ASSERT_EQ(read.warnings.size(), 1U);
        EXPECT_EQ(read.warnings[0], "1 blocks of light from behind are not read");
    }
    const std::string all =
        replaced(replaced(small(), "Side  Front", "Side Back"), "Side  Front", "Side Back");
    const auto read = parsed(all);
    EXPECT_EQ(read.content.blocks.size(), 2U);
    EXPECT_EQ(read.about.at(kLightToolsSide), "back");
    ASSERT_FALSE(read.warnings.empty());
    const std::string written = writeLightTools(read.content, read.about).bytes;
    EXPECT_NE(written.find("Side  Back"), std::string::npos);
    EXPECT_EQ(written.find("Side  Front"), std::string::npos);
}

TEST(LightToolsReader, MasksWhatMiniDiffExtrapolates) {
    const std::string text = miniDiffLike();
    const auto read = parsed(text);
    ASSERT_EQ(read.content.blocks.size(), 24U);
    const std::size_t masked = std::size_t{24} * 361 * 15;
    ASSERT_FALSE(read.warnings.empty());
    EXPECT_EQ(read.warnings[0].find(std::to_string(masked) + " values beyond 75 degrees"), 0U);
    std::size_t missing = 0;
    for (const SphericalBlock& block : read.content.blocks) {
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                const double theta = block.thetaDeg[t];
                const double fromNormal = block.transmission ? 180 - theta : theta;
                EXPECT_EQ(std::isnan(block.f[block.index(a, t)]), fromNormal > 75);
                missing += std::isnan(block.f[block.index(a, t)]) ? 1U : 0U;
            }
        }
    }
    EXPECT_EQ(missing, masked);
    EXPECT_TRUE(parsed(text, VendorExtrapolation::Kept).warnings.empty());
    EXPECT_TRUE(parsed(miniDiffLike(3)).warnings.empty());  // another layout
}

TEST(LightToolsReader, WarnsOfNegativeValuesAndOfPeaksElsewhere) {
    EXPECT_EQ(parsed(replaced(small(), "0.4", "-0.4")).warnings,
              std::vector<std::string>{"1 negative values"});
    const auto lobe = [](const LightView& pair, std::size_t) { return test::mirrorLobe(pair, 10); };
    const auto back = [&](const LightView& pair, std::size_t channel) {
        return lobe({.in = mirrorOf(pair.in), .out = pair.out}, channel);
    };
    const auto read = [](const SphericalTable& table) {
        return parsed(writeLightTools(table, {}).bytes);
    };
    EXPECT_TRUE(read(sphericalTable({}, lobe)).warnings.empty());
    const auto wrong = read(sphericalTable({}, back));
    ASSERT_EQ(wrong.warnings.size(), 1U);
    EXPECT_NE(wrong.warnings[0].find("azimuth 90"), std::string::npos);
}

TEST(LightToolsWriter, ReadsBackTheSameBytesAndModels) {
    for (const char* spec : {"lambert,albedo=0.3/0.2/0.1", "ggx,alpha=0.3,f0=0.5/0.4/0.3"}) {
        for (const bool symmetrical : {false, true}) {
            const SphericalTable table =
                sphericalTable({.channels = Channel::ofBands(),
                                .planeSymmetrical = symmetrical,
                                .azimuthDeg = steps(0, symmetrical ? 180 : 360, 10),
                                .thetaDeg = steps(0, 85, 5)},
                               test::ModelValue(spec));
            Metadata about;
            about.set(key::kSample, "two\nlines");
            about.comments = {"free text"};
            const Written once = writeLightTools(table, about);
            EXPECT_TRUE(once.loss.items.empty());
            const auto read = parsed(once.bytes);
            test::expectSameAtNodes(table, read.content, 1e-12);
            EXPECT_EQ(read.about, about);
            EXPECT_EQ(writeLightTools(read.content, read.about).bytes, once.bytes);
        }
    }
}

TEST(LightToolsWriter, StatesTheAlbedoOfALambertianAsItsTis) {
    const auto lambert = [](const LightView&, std::size_t) { return 0.4 / kPi; };
    const auto read = parsed(writeLightTools(sphericalTable({}, lambert), {}).bytes);
    for (const SphericalBlock& block : read.content.blocks) EXPECT_NEAR(block.tis, 0.4, 1e-12);
}

TEST(LightToolsWriter, KeepsHandednessTransmissionAndLightAzimuths) {
    for (const double mirror : {0.0, 90.0, 180.0, 270.0}) {
        for (const bool transmission : {false, true}) {
            const SphericalTable table = sphericalTable(
                {.mirrorAzimuthDeg = mirror,
                 .lightAzimuthDeg = {0, 120, 240},
                 .thetaDeg = transmission ? steps(95, 180, 5) : steps(0, 85, 5),
                 .transmission = transmission},
                [](const LightView& pair, std::size_t) { return test::handedValue(pair); });
            const auto read = parsed(writeLightTools(table, {}).bytes);
            test::expectSameAtNodes(table, read.content, 1e-12);
            EXPECT_EQ(read.warnings.size(), 1U);  // of POI
        }
    }
}

TEST(LightToolsWriter, PutsTheLobeAtTheMirrorDirection) {
    const SphericalTable table = sphericalTable(
        {.mirrorAzimuthDeg = 0, .azimuthDeg = steps(0, 355, 5)},
        [](const LightView& pair, std::size_t) { return test::mirrorLobe(pair, 3); });
    const auto read = parsed(writeLightTools(table, {}).bytes);
    EXPECT_EQ(read.content.mirrorAzimuthDeg, 270);
    test::expectPeaksAtMirror(read.content);
}

TEST(LightToolsWriter, KeepsXyzApart) {
    const SphericalTable table = sphericalTable(
        {.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}}, .mirrorAzimuthDeg = 270},
        [](const LightView&, std::size_t channel) { return 1.0 + static_cast<double>(channel); });
    const std::string once = writeLightTools(table, {}).bytes;
    const auto read = parsed(once);
    EXPECT_EQ(read.content.channels, table.channels);
    ASSERT_EQ(read.content.blocks.size(), table.blocks.size());
    for (std::size_t i = 0; i < table.blocks.size(); ++i) {
        EXPECT_EQ(read.content.blocks[i].f, table.blocks[i].f);
        EXPECT_EQ(read.content.blocks[i].channel, table.blocks[i].channel);
    }
    EXPECT_EQ(writeLightTools(read.content, {}).bytes, once);
    EXPECT_TRUE(refuses(parseLightTools(replaced(once, "TristimulusValue  TrisX\n", ""), "in"),
                        {"no TristimulusValue"}));
}

TEST(LightToolsWriter, ReportsWhatIsLost) {
    SphericalTable table =
        sphericalTable({.channels = {Channel::of(Band::R), {"a", {}}, {"b", {}}}},
                       [](const LightView&, std::size_t) { return 1.0; });
    table.blocks[0].f[3] = std::nan("");
    table.blocks[2].thetaDeg[1] = 7;
    const Written written = writeLightTools(table, {});
    EXPECT_EQ(written.loss.items,
              (std::vector<LossReport::Item>{
                  {Loss::Dropped, "blocks of a channel without a wavelength of its own", 4},
                  {Loss::Dropped, "blocks on other axes than the first", 1},
                  {Loss::Masked, "nodes without data, written as 0", 1}}));
    EXPECT_EQ(parsed(written.bytes).content.blocks.size(), 7U);
}

}  // namespace
}  // namespace gonio::proc
