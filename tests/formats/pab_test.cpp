#include "proc/formats/pab.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/formats/refusal.h"
#include "tests/formats/row_lists.h"
#include "tests/formats/small_files.h"

namespace gonio::proc {
namespace {

using test::expectSameRows;
using test::refuses;
using test::replaced;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string smallPab() {
    return "#data written by hand\n"
           "#sample_name \"blind\"\n"
           "#incident_angle 30 90\n"
           "#intheta 30\n"
           "#inphi 90\n"
           "#upphi 45\n"
           "#datapoints_in_file: 2\n"
           "#format: theta phi DSF\n"
           "60 270 0.25\n"
           "120.000\t10 0.5\n";
}

FileRead<BrdfRows> parsed(const std::string& text) {
    auto read = parsePab(text, "in.txt");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : FileRead<BrdfRows>{};
}
WrittenPab written(const BrdfRows& rows, const Metadata& about = {}) {
    auto out = writePab(rows, about);
    EXPECT_TRUE(out);
    return out ? std::move(*out) : WrittenPab{};
}

/// The rows of one light.
BrdfRows ofLight(const BrdfRows& rows, double thetaDeg) {
    BrdfRows own{.channels = rows.channels,
                 .pairs = {},
                 .f = {},
                 .uRandom = {},
                 .uSystematic = {},
                 .flags = {},
                 .isotropic = rows.isotropic};
    for (std::size_t i = 0; i < rows.pairs.size(); ++i) {
        if (std::abs(rows.pairs[i].in.theta().degrees() - thetaDeg) > 1e-6) continue;
        own.pairs.push_back(rows.pairs[i]);
        for (std::size_t c = 0; c < rows.channels.size(); ++c) {
            own.f.push_back(rows.f[rows.index(i, c)]);
        }
    }
    return own;
}
BrdfRows oneChannel(BrdfRows rows, const Channel& channel) {
    rows.channels = {channel};
    std::vector<double> f;
    for (std::size_t i = 0; i < rows.f.size(); i += 3) f.push_back(rows.f[i]);
    rows.f = f;
    return rows;
}

TEST(Pab, ReadsAFileWithTheCosine) {
    const FileRead<BrdfRows> read = parsed(smallPab());
    const BrdfRows& rows = read.content;
    EXPECT_EQ(rows.channels, std::vector<Channel>{Channel{}});
    ASSERT_EQ(rows.pairs.size(), 2U);
    EXPECT_NEAR(rows.pairs[0].in.phi().degrees(), 90, 1e-12);
    EXPECT_NEAR(rows.f[0], 0.5, 1e-15);  // over cos 60
    EXPECT_NEAR(rows.f[1], 1.0, 1e-15);  // over |cos 120|
    EXPECT_LT(rows.pairs[1].out.z(), 0);
    EXPECT_EQ(read.about.at(key::kSample), "blind");
    EXPECT_EQ(read.about.at("pab.upphi"), "45");
    EXPECT_EQ(read.about.comments, std::vector<std::string>{"data written by hand"});
    for (const char* kind : {"BSDF", "BRDF"}) {
        EXPECT_EQ(parsed(replaced(smallPab(), "DSF", kind)).content.f[0], 0.25);
    }
    EXPECT_EQ(parsed(replaced(smallPab(), "DSF", "btdf")).warnings,
              std::vector<std::string>{"1 rows of a BTDF on the light's side of the surface"});
}

TEST(Pab, WritesTheSameBytesAgain) {
    Metadata about;
    about.set(key::kSample, "tile");
    about.set("pab.upphi", "45");
    about.comments = {"one", "two: three"};
    for (const Channel& channel : {Channel{}, Channel{"", 525}}) {
        const BrdfRows rows = ofLight(oneChannel(test::asymmetricRows(30), channel), 40);
        const WrittenPab once = written(rows, about);
        EXPECT_TRUE(once.loss.items.empty());
        ASSERT_EQ(once.files.size(), 1U);
        EXPECT_EQ(once.files[0].suffix, "_t040p030");
        const FileRead<BrdfRows> back = parsed(once.files[0].bytes);
        expectSameRows(back.content, rows);
        EXPECT_EQ(back.about, about);
        const WrittenPab twice = written(back.content, back.about);
        EXPECT_EQ(twice.files[0].bytes, once.files[0].bytes);
    }
}

TEST(Pab, WritesAFileForEachLightSideAndChannel) {
    BrdfRows rows = test::asymmetricRows();
    rows.pairs[1].out = Direction::fromSpherical(150_deg, 0_deg);  // of the light at the normal
    const WrittenPab out = written(rows);
    ASSERT_EQ(out.files.size(), 5U * 3U);
    EXPECT_EQ(out.files[0].suffix, "_t000p000_r");
    EXPECT_EQ(out.files[5].suffix, "_t000p000_back_b");
    EXPECT_EQ(out.files[14].suffix, "_t060p000_b");
    EXPECT_NE(out.files[3].bytes.find("BTDF"), std::string::npos);
    ASSERT_EQ(out.loss.items.size(), 1U);
    EXPECT_EQ(out.loss.items[0].what, "names of channels");
    const BrdfRows blue = parsed(out.files[14].bytes).content;
    EXPECT_EQ(blue.channels, (std::vector<Channel>{{"", 465}}));
    const BrdfRows own = ofLight(rows, 60);
    for (std::size_t i = 0; i < own.pairs.size(); ++i) EXPECT_EQ(blue.f[i], own.f[3 * i + 2]);
}

TEST(Pab, KeepsXyzTogether) {
    BrdfRows rows = ofLight(test::asymmetricRows(), 20);
    rows.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}};
    const WrittenPab out = written(rows);
    ASSERT_EQ(out.files.size(), 1U);
    EXPECT_TRUE(out.loss.items.empty());
    expectSameRows(parsed(out.files[0].bytes).content, rows);
}

TEST(Pab, HoldsModelsAtNodesAndTheirMirror) {
    for (const char* spec : {"lambert,albedo=0.5", "ggx,alpha=0.05,f0=0.9"}) {
        const BrdfRows rows = oneChannel(test::modelRows(spec), {});
        for (const PabFile& file : written(rows).files) {
            const BrdfRows back = parsed(file.bytes).content;
            expectSameRows(back, ofLight(rows, back.pairs[0].in.theta().degrees()));
            if (spec[0] == 'g') test::expectPeaksAtTheMirror(back);
        }
    }
}

TEST(Pab, CountsWhatItCannotHold) {
    BrdfRows rows = test::measuredRows();
    rows.f[4] = kNan;
    const WrittenPab out = written(rows);
    ASSERT_EQ(out.loss.items.size(), 4U);
    EXPECT_EQ(out.loss.items[0],
              (LossReport::Item{Loss::Masked, "missing values of all its files, left out", 1}));
    EXPECT_EQ(out.loss.items[1].what, "uncertainties");
    EXPECT_EQ(out.loss.items[2].what, "flags beside measured");
}

TEST(Pab, RefusesToWriteScatteredLights) {
    BrdfRows rows = oneChannel(test::asymmetricRows(), {});
    for (int i = 0; i < 520; ++i) {
        rows.pairs.push_back(test::pairOfDegrees(0.1 * i, 10, 20, 30));
        rows.f.push_back(1);
    }
    const auto out = writePab(rows, {});
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().kind, ErrorKind::Usage);
}

TEST(Pab, ReadsAnyLineEndsAndAByteOrderMark) {
    for (const char* end : {"\r\n", "\r"}) {
        std::string text = "\xEF\xBB\xBF";
        for (const char c : smallPab()) text += c == '\n' ? std::string(end) : std::string(1, c);
        expectSameRows(parsed(text).content, parsed(smallPab()).content);
        EXPECT_TRUE(refuses(parsePab(replaced(text, "0.25", "x"), "in"), {"pab: in: line 9: 'x'"}));
    }
}

TEST(Pab, SaysWhatIsWrong) {
    const auto refused = [](std::string_view from, std::string_view to) {
        return parsePab(replaced(smallPab(), from, to), "in");
    };
    for (const char* word : {"banana", "nan", "inf", "-inf", "1e999", "0x10", "0,5", "1.5.2"}) {
        EXPECT_TRUE(refuses(refused("0.25", word), {"pab: in: line 9: "})) << word;
    }
    EXPECT_TRUE(refuses(refused("0.25", ""), {"line 9: 2 numbers, wanted theta, phi and 1 value"}));
    EXPECT_TRUE(refuses(refused("60 270", "181 270"), {"line 9: a theta of '181'"}));
    EXPECT_TRUE(refuses(refused("60 270", "-1 270"), {"line 9: a theta of '-1'"}));
    EXPECT_TRUE(refuses(refused("#intheta 30", "#intheta 31"), {"said before to be 30"}));
    EXPECT_TRUE(refuses(refused("#intheta 30", "#inphi 90"), {"#inphi is given twice"}));
    EXPECT_TRUE(refuses(refused("#inphi 90", "#inphi x"), {"line 5: #inphi: 'x', wanted degrees"}));
    EXPECT_TRUE(refuses(refused("angle 30 90", "angle 30"), {"line 3: #incident_angle '30'"}));
    EXPECT_TRUE(refuses(refused("theta phi DSF", "phi theta DSF"), {"line 8: #format"}));
    EXPECT_TRUE(refuses(refused("#format: theta phi DSF\n", ""), {"no #format"}));
    EXPECT_TRUE(refuses(refused("file: 2", "file: 3"), {"2 rows", "promised 3"}));
    EXPECT_TRUE(refuses(refused("file: 2", "file: -2"), {"line 7: #datapoints_in_file: '-2'"}));
    EXPECT_TRUE(refuses(refused("#upphi 45", "#colorimetry: sRGB"), {"line 6: #colorimetry"}));
    EXPECT_TRUE(refuses(parsePab(smallPab() + "#intheta 30\n", "in"), {"is given twice"}));
    EXPECT_TRUE(refuses(parsePab("", "in"), {"pab: in: line 0: no row"}));
    const std::string noAngle =
        replaced(replaced(smallPab(), "#incident_angle 30 90\n", ""), "#intheta 30\n", "");
    EXPECT_TRUE(refuses(parsePab(noAngle, "in"), {"no #intheta"}));
}

TEST(Pab, RefusesATextCutAtAnyByte) {
    const std::string text = smallPab();
    for (std::size_t size = 0; size + 4 < text.size(); ++size) {
        EXPECT_TRUE(refuses(parsePab(text.substr(0, size), "cut"), {"pab: cut: line "})) << size;
    }
}

TEST(Pab, IsNotWrittenWithoutAValue) {
    BrdfRows rows = test::asymmetricRows();
    rows.f.assign(rows.f.size(), kNan);
    const auto out = writePab(rows, {});
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().kind, ErrorKind::Usage);
}

TEST(Pab, GivesEachChannelAFileOfItsOwnName) {
    BrdfRows rows = test::asymmetricRows();
    rows.channels = {{"a b", {}}, {"A_B", {}}, {"c", {}}};
    std::set<std::string> suffixes;
    const WrittenPab out = written(rows);
    for (const PabFile& file : out.files) suffixes.insert(file.suffix);
    EXPECT_EQ(suffixes.size(), out.files.size());
}

}  // namespace
}  // namespace gonio::proc
