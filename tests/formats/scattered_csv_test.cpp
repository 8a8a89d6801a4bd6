#include "proc/formats/scattered_csv.h"

#include <gtest/gtest.h>

#include <limits>

#include "proc/formats/points_csv.h"
#include "proc/table/rotations.h"
#include "proc/table/rows_of.h"
#include "tests/formats/refusal.h"
#include "tests/formats/row_lists.h"
#include "tests/formats/small_files.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

using test::expectSameRows;
using test::refuses;
using test::replaced;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FileRead<BrdfRows> parsed(const std::string& text) {
    auto read = parseScatteredCsv(text, "in.csv");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : FileRead<BrdfRows>{};
}

std::string smallCsv() {
    return "# gonio.sample: tile\n"
           "# a comment\n"
           "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b,u_r,u_g,u_b,flags_r,flags_g,flags_b\n"
           "30,0,20,90,0.5,0.25,0.125,0.01,0.02,0.03,1,1,3\n"
           "30,0,40,270,,0.5,-0.25,,,0.25,8,1,1\n";
}

TEST(ScatteredCsv, ReadsItsColumns) {
    const FileRead<BrdfRows> read = parsed(smallCsv());
    const BrdfRows& rows = read.content;
    EXPECT_EQ(rows.channels, Channel::ofBands());
    ASSERT_EQ(rows.pairs.size(), 2U);
    EXPECT_EQ(rows.f[2], 0.125);
    EXPECT_FALSE(rows.hasData(1, 0));
    EXPECT_EQ(rows.uRandom[1], 0.02);
    EXPECT_TRUE(rows.uSystematic.empty());
    EXPECT_EQ(rows.flags[2], (Flags{Flag::Measured, Flag::Saturated}));
    EXPECT_EQ(rows.flags[3], Flags{Flag::Blocked});
    EXPECT_TRUE(rows.isotropic);
    EXPECT_EQ(read.about.at(key::kSample), "tile");
    EXPECT_EQ(read.about.comments, std::vector<std::string>{"a comment"});
    EXPECT_EQ(read.warnings, std::vector<std::string>{"1 negative values"});
}

// Found by libFuzzer: a channel "random_r" has its u where u_random of the channel r stands.
TEST(ScatteredCsv, RefusesChannelsThatWouldShareAColumn) {
    for (const char* name : {"f_random_r", "f_systematic_b"}) {
        EXPECT_TRUE(refuses(parseScatteredCsv(replaced(smallCsv(), "f_g", name), "in"),
                            {"csv: in: line ", name}));
    }
}

TEST(ScatteredCsv, WritesTheSameBytesAgain) {
    for (BrdfRows rows : {test::measuredRows(), test::asymmetricRows(30)}) {
        for (const bool isotropic : {true, false}) {
            rows.isotropic = isotropic;
            rows.f[4] = kNan;
            Metadata about;
            about.set(key::kSample, "a, \"b\"\nc");
            about.comments = {"one", "", "  two"};
            const Written once = writeScatteredCsv(rows, about);
            EXPECT_TRUE(once.loss.items.empty());
            const FileRead<BrdfRows> back = parsed(once.bytes);
            expectSameRows(back.content, rows);
            EXPECT_EQ(back.about, about);
            EXPECT_EQ(writeScatteredCsv(back.content, back.about).bytes, once.bytes);
        }
    }
    const FileRead<BrdfRows> read = parsed(smallCsv());
    EXPECT_EQ(writeScatteredCsv(read.content, read.about).bytes, smallCsv());
}

TEST(ScatteredCsv, IsWhatASampleIsExportedAs) {
    SampleSet set = test::sampleSet([](Radians incidence, const Direction& wo) {
        return 1 + incidence.value() + 0.3 * wo.x() + 0.2 * wo.y();
    });
    set.leds = {set.leds[1], set.leds[2]};
    set.leds[1].rotation = rotationOf(30);
    const std::string exported = writeScatteredCsv(rowsOf(set), {}).bytes;
    EXPECT_TRUE(exported.starts_with(
        "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b,u_r,u_g,u_b,"
        "u_random_r,u_random_g,u_random_b,u_systematic_r,u_systematic_g,u_systematic_b,"
        "flags_r,flags_g,flags_b\n20,0,0.5,60,"))
        << exported.substr(0, 300);
    const auto back = sampleOf(parsed(exported).content, {});
    ASSERT_TRUE(back);
    ASSERT_EQ(back->set.leds.size(), 2U);
    EXPECT_EQ(back->set.leds[1].rotation, rotationOf(30));
    EXPECT_EQ(back->set.leds[1].bands[1].uSystematic[5000], set.leds[1].bands[1].uSystematic[5000]);
}

TEST(ScatteredCsv, NamesChannelsOfAnyKind) {
    for (const std::vector<Channel>& channels :
         {std::vector<Channel>{{"X", {}}, {"Y", {}}, {"Z", {}}},
          std::vector<Channel>{{"", 650}, {"", 500.5}, {"a, b", 500.5}},
          std::vector<Channel>{{"R", 650}, {"@", {}}, {"\"#", {}}}}) {
        BrdfRows rows = test::asymmetricRows();
        rows.channels = channels;
        expectSameRows(parsed(writeScatteredCsv(rows, {}).bytes).content, rows);
    }
    const FileRead<BrdfRows> one = parsed("theta_i,phi_i,theta_o,phi_o,f\n1,2,3,4,5\n");
    EXPECT_EQ(one.content.channels, std::vector<Channel>{Channel{}});
    EXPECT_EQ(parsed("theta_i,phi_i,theta_o,phi_o,f_650nm\n1,2,3,4,5\n").content.channels,
              (std::vector<Channel>{{"", 650}}));
}

TEST(ScatteredCsv, ReadsVectorsAndOneMaskForAll) {
    const FileRead<BrdfRows> read = parsed(
        "flags,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f_r,f_g,source\n"
        "64,0,0,2,0,3,4,0.5,,interpolated\n");
    const BrdfRows& rows = read.content;
    EXPECT_EQ(rows.pairs[0].out.y(), 0.6);
    EXPECT_EQ(rows.channels, (std::vector<Channel>{Channel::of(Band::R), Channel::of(Band::G)}));
    EXPECT_EQ(rows.flags[0], Flags{Flag::Interpolated});
    EXPECT_EQ(rows.flags[1], Flags{Flag::Interpolated});
}

TEST(ScatteredCsv, HoldsModelsAtNodesAndTheirMirror) {
    for (const char* spec : {"lambert,albedo=0.5", "ggx,alpha=0.05,f0=0.9"}) {
        const BrdfRows rows = test::modelRows(spec);
        const BrdfRows back = parsed(writeScatteredCsv(rows, {}).bytes).content;
        expectSameRows(back, rows);
        if (spec[0] == 'g') test::expectPeaksAtTheMirror(back);
    }
}

TEST(ScatteredCsv, KeepsTransmission) {
    BrdfRows rows = test::asymmetricRows();
    rows.pairs[3].out = Direction::fromSpherical(130_deg, 20_deg);
    expectSameRows(parsed(writeScatteredCsv(rows, {}).bytes).content, rows);
}

TEST(ScatteredCsv, CountsWhatIsNotFinite) {
    BrdfRows rows = test::asymmetricRows();
    rows.f[0] = std::numeric_limits<double>::infinity();
    const Written out = writeScatteredCsv(rows, {});
    ASSERT_EQ(out.loss.items.size(), 1U);
    EXPECT_EQ(out.loss.items[0].kind, Loss::Masked);
    EXPECT_FALSE(parsed(out.bytes).content.hasData(0, 0));
}

TEST(ScatteredCsv, ReadsAnyLineEndsAndAByteOrderMark) {
    for (const char* end : {"\r\n", "\r"}) {
        std::string text = "\xEF\xBB\xBF";
        for (const char c : smallCsv()) text += c == '\n' ? std::string(end) : std::string(1, c);
        expectSameRows(parsed(text).content, parsed(smallCsv()).content);
        EXPECT_TRUE(refuses(parseScatteredCsv(replaced(text, "0.125", "x"), "in"),
                            {"csv: in: line 4: f_b: 'x'"}));
    }
}

TEST(ScatteredCsv, SaysWhatIsWrong) {
    const auto refused = [](std::string_view from, std::string_view to) {
        return parseScatteredCsv(replaced(smallCsv(), from, to), "in");
    };
    for (const char* word : {"banana", "inf", "-inf", "1e999", "0x10", "1.5.2", "1 2"}) {
        EXPECT_TRUE(refuses(refused("0.125", word), {"csv: in: line 4: f_b: "})) << word;
    }
    EXPECT_TRUE(refuses(refused("0.125", "0,125"), {"line 4: 14 fields", "a decimal comma?"}));
    EXPECT_TRUE(refuses(refused("0.125", "\"0,125\""), {"'0,125'", "with a decimal point"}));
    EXPECT_TRUE(refuses(refused("theta_i,phi_i,", "theta_i;phi_i;"), {"commas between fields"}));
    EXPECT_TRUE(refuses(refused("0.03", "-0.03"), {"line 4: u_b: -0.03, wanted 0 or more"}));
    EXPECT_TRUE(refuses(refused("1,1,3", "1,1,1.5"), {"line 4: flags_b: '1.5'", "a mask"}));
    EXPECT_TRUE(refuses(refused("1,1,3", "1,1,"), {"line 4: flags_b: ''", "a mask"}));
    EXPECT_TRUE(refuses(refused("f_r,f_g", "f_g,f_g"), {"column f_g is there twice"}));
    EXPECT_TRUE(refuses(refused("u_r,u_g", "u_g,u_g"), {"column u_g is there twice"}));
    EXPECT_TRUE(refuses(refused("f_r,f_g", "f,f_g"), {"a column f beside"}));
    EXPECT_TRUE(refuses(refused("f_r,f_g,f_b", "a,b,c"), {"no column of values"}));
    EXPECT_TRUE(refuses(parseScatteredCsv("", "in"), {"csv: in: line 0: no header"}));
    EXPECT_TRUE(refuses(parseScatteredCsv("theta_i,phi_i,theta_o,phi_o,f\n", "in"), {"no row"}));
}

TEST(ScatteredCsv, SurvivesATextCutAtAnyByte) {
    const std::string text = smallCsv();
    for (std::size_t size = 0; size < text.size(); ++size) {
        const auto read = parseScatteredCsv(text.substr(0, size), "cut.csv");
        if (!read) {
            EXPECT_TRUE(refuses(read, {"csv: cut.csv: line "}));
        }
    }
}

TEST(ScatteredCsv, NumbersNamesThatWouldNotComeBack) {
    BrdfRows rows = test::asymmetricRows();
    const auto names = [&](const std::vector<Channel>& channels, std::size_t changed) {
        rows.channels = channels;
        const Written out = writeScatteredCsv(rows, {});
        const std::vector<LossReport::Item> lost{{Loss::Clamped, "names of channels", changed}};
        EXPECT_EQ(out.loss.items, changed > 0 ? lost : std::vector<LossReport::Item>{});
        std::vector<std::string> back;
        for (const Channel& channel : parsed(out.bytes).content.channels) {
            back.push_back(channel.name);
            EXPECT_EQ(channel.nanometres, channels[back.size() - 1].nanometres);
        }
        return back;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names({{"a\nb", {}}, {"a b", {}}, {"c ", {}}}, 3),
              (Names{"a b", "channel 2 a b", "c"}));
    EXPECT_EQ(names({{"random", {}}, {"systematic", {}}, {"u", {}}}, 2),
              (Names{"channel 1 random", "channel 2 systematic", "u"}));
    EXPECT_EQ(names({{"550nm", {}}, {"", 550}, {"r", {}}}, 2),
              (Names{"channel 1 550nm", "", "channel 3 r"}));
    EXPECT_EQ(names({{"a@5nm", {}}, {"a", 5}, {"a", 5}}, 2),
              (Names{"channel 1", "a", "channel 3 a"}));
    EXPECT_EQ(names({{}, {"channel 1", {}}, {}}, 1),
              (Names{"channel 1", "channel 2 channel 1", "channel 3"}));
}

}  // namespace
}  // namespace gonio::proc
