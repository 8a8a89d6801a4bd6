#include "proc/formats/astm.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/formats/refusal.h"
#include "tests/formats/row_lists.h"
#include "tests/formats/small_files.h"

namespace gonio::proc {
namespace {

using test::expectSameRows;
using test::refuses;
using test::replaced;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// As a goniometer of the field writes it.
std::string smallAstm() {
    return "LAB_NAME A LABORATORY\n"
           "\n"
           "APERTURE Circular\n"
           "SAMPLE_NAME \"tile\"\n"
           "MEAS_NAME BRDF\n"
           "NUM_POINTS 2\n"
           "VARS theta_i,phi_i,theta_s,phi_s,465nm,525nm,630nm\n"
           "0.5,0,0.25,-1.5,0.1,0.2,0.3\n"
           "\n"
           "0.5,0,1.25,3,-0.1,0.4,0.5\n";
}

FileRead<BrdfRows> parsed(const std::string& text) {
    auto read = parseAstm(text, "in.astm");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : FileRead<BrdfRows>{};
}
std::string written(const FileRead<BrdfRows>& read) {
    return writeAstm(read.content, read.about)->bytes;
}

TEST(Astm, ReadsWhatTheFieldWrites) {
    const FileRead<BrdfRows> read = parsed(smallAstm());
    const BrdfRows& rows = read.content;
    EXPECT_EQ(rows.channels, (std::vector<Channel>{{"", 465}, {"", 525}, {"", 630}}));
    ASSERT_EQ(rows.pairs.size(), 2U);
    EXPECT_NEAR(rows.pairs[0].in.theta().value(), 0.5, 1e-15);
    EXPECT_NEAR(rows.pairs[0].out.phi().value(), 2 * kPi - 1.5, 1e-14);
    EXPECT_EQ(rows.f[5], 0.5);
    EXPECT_TRUE(rows.isotropic);
    EXPECT_EQ(read.about.at(key::kSample), "tile");
    EXPECT_EQ(read.about.at("astm.LAB_NAME"), "A LABORATORY");
    EXPECT_EQ(read.warnings, std::vector<std::string>{"1 negative values"});
}

TEST(Astm, WritesTheSameBytesAgain) {
    for (BrdfRows rows : {test::asymmetricRows(), test::asymmetricRows(30)}) {
        for (const bool isotropic : {true, false}) {
            rows.isotropic = isotropic;
            Metadata about;
            about.set(key::kSample, "a \"b\"");
            about.set("astm.LAB_NAME", "somewhere");
            about.comments = {"one", "", "two"};
            const auto made = writeAstm(rows, about);
            ASSERT_TRUE(made);
            const Written& once = *made;
            EXPECT_TRUE(once.loss.items.empty());
            const FileRead<BrdfRows> back = parsed(once.bytes);
            expectSameRows(back.content, rows, 0, 2e-12);  // of radians rounded to 1e-12
            EXPECT_EQ(back.about, about);
            EXPECT_EQ(written(back), once.bytes);
        }
    }
    const std::string foreign = written(parsed(smallAstm()));
    EXPECT_EQ(written(parsed(foreign)), foreign);
}

TEST(Astm, HoldsModelsAtNodesAndTheirMirror) {
    for (const char* spec : {"lambert,albedo=0.5", "ggx,alpha=0.05,f0=0.9"}) {
        const BrdfRows rows = test::modelRows(spec);
        const BrdfRows back = parsed(writeAstm(rows, {})->bytes).content;
        expectSameRows(back, rows, 0, 2e-12);
        if (spec[0] == 'g') test::expectPeaksAtTheMirror(back);
    }
}

TEST(Astm, ReadsThreeAngles) {
    std::string text = replaced(smallAstm(), "theta_i,phi_i,theta_s", "theta_i,theta_s");
    text = replaced(replaced(text, "0.5,0,0.25", "0.5,0.25"), "0.5,0,1.25", "0.5,1.25");
    expectSameRows(parsed(text).content, parsed(smallAstm()).content);
}

TEST(Astm, KeepsChannelsOfAnyKind) {
    for (const std::vector<Channel>& channels :
         {std::vector<Channel>{{"X", {}}, {"Y", {}}, {"Z", {}}},
          std::vector<Channel>{{"", 400}, {"", 500.5}, {"", 600}},
          Channel::ofBands()}) {
        BrdfRows rows = test::asymmetricRows();
        rows.channels = channels;
        expectSameRows(parsed(writeAstm(rows, {})->bytes).content, rows, 0, 2e-12);
    }
    BrdfRows one = test::asymmetricRows();
    one.channels = {Channel{}};
    one.f.resize(one.pairs.size());
    expectSameRows(parsed(writeAstm(one, {})->bytes).content, one, 0, 2e-12);
    const std::string total = replaced(
        replaced(
            replaced(smallAstm(), "465nm,525nm,630nm", "Integrated total"), "0.1,0.2,0.3", "0.1"),
        "-0.1,0.4,0.5",
        "0.5");
    EXPECT_EQ(parsed(total).content.channels, (std::vector<Channel>{{"Integrated total", {}}}));
}

TEST(Astm, CountsWhatItCannotHold) {
    BrdfRows rows = test::measuredRows();
    rows.f[4] = kNan;
    const auto made = writeAstm(rows, {});
    ASSERT_TRUE(made);
    const Written& out = *made;
    const std::size_t flagged = (rows.flags.size() + 4) / 5;
    EXPECT_EQ(out.loss.items,
              (std::vector<LossReport::Item>{
                  {Loss::Masked, "missing values, left out", 1},
                  {Loss::Dropped, "values beside a missing one, left out with it", 2},
                  {Loss::Dropped, "uncertainties", rows.f.size()},
                  {Loss::Dropped, "flags beside measured", flagged}}));
    EXPECT_EQ(parsed(out.bytes).content.pairs.size(), rows.pairs.size() - 1);
}

TEST(Astm, KeepsTheHorizonAndTransmission) {
    BrdfRows rows = test::asymmetricRows();
    rows.pairs[3].out = Direction::fromSpherical(130_deg, 20_deg);
    rows.pairs[4].out = *Direction::fromVector({1, 0, 0});
    const BrdfRows back = parsed(writeAstm(rows, {})->bytes).content;
    expectSameRows(back, rows, 0, 2e-12);
    EXPECT_LE(back.pairs[4].out.z(), 0);
    EXPECT_NEAR(back.pairs[4].out.z(), 0, 1e-15);
}

TEST(Astm, ReadsAnyLineEndsAndAByteOrderMark) {
    for (const char* end : {"\r\n", "\r"}) {
        std::string text = "\xEF\xBB\xBF";
        for (const char c : smallAstm()) text += c == '\n' ? std::string(end) : std::string(1, c);
        expectSameRows(parsed(text).content, parsed(smallAstm()).content);
        EXPECT_TRUE(
            refuses(parseAstm(replaced(text, "0.2,", "x,"), "in"), {"astm: in: line 8: 'x'"}));
    }
}

TEST(Astm, SaysWhatIsWrong) {
    const auto refused = [](std::string_view from, std::string_view to) {
        return parseAstm(replaced(smallAstm(), from, to), "in");
    };
    for (const char* word : {"banana", "nan", "inf", "-inf", "1e999", "0x10", "1.5.2", ""}) {
        EXPECT_TRUE(refuses(refused("0.3\n", std::string(word) + "\n"), {"astm: in: line 8: "}))
            << word;
    }
    EXPECT_TRUE(refuses(refused("0.3\n", "0,3\n"), {"line 8: 8 values, VARS has 7"}));
    EXPECT_TRUE(refuses(refused("0.4,0.5\n", "0.4\n"), {"line 10: 6 values, VARS has 7"}));
    EXPECT_TRUE(refuses(parseAstm(smallAstm() + "junk\n", "in"), {"line 11: 1 values"}));
    EXPECT_TRUE(refuses(refused("NUM_POINTS 2", "NUM_POINTS 3"), {"2 rows", "promised 3"}));
    for (const char* count : {"-1", "x", "1e3", "9223372036854775808"}) {
        EXPECT_TRUE(refuses(refused("NUM_POINTS 2", std::string("NUM_POINTS ") + count),
                            {"line 6: NUM_POINTS: "}));
    }
    EXPECT_TRUE(refuses(refused("NUM_POINTS 2", "NUM_POINTS 9223372036854775807"), {"promised"}));
    EXPECT_TRUE(refuses(refused("APERTURE", "Lab_name"), {"line 3: 'Lab_name' is given twice"}));
    EXPECT_TRUE(refuses(refused("525nm", "465nm"), {"line 7: '465nm' is in VARS twice"}));
    EXPECT_TRUE(refuses(refused("theta_s,phi_s", "phi_s,theta_s"), {"line 7: VARS"}));
    EXPECT_TRUE(refuses(refused("465nm,525nm", "465nm,"), {"without a name"}));
    EXPECT_TRUE(refuses(refused("phi_s,465nm,525nm,630nm", "phi_s"), {"line 7: VARS"}));
    EXPECT_TRUE(refuses(refused("0.5,0,0.25", "30,0,0.25"), {"a theta of 30, wanted radians"}));
    EXPECT_TRUE(refuses(refused("0.5,0,0.25", "0.5,0,-0.25"), {"a theta of -0.25"}));
    EXPECT_TRUE(refuses(parseAstm("", "in"), {"astm: in: line 0: the text ends, wanted VARS"}));
    EXPECT_TRUE(refuses(parseAstm("tensor_file\0\1\0", "in"), {"wanted VARS"}));
}

TEST(Astm, RefusesATextCutAtAnyByte) {
    const std::string text = smallAstm();
    for (std::size_t size = 0; size + 4 < text.size(); ++size) {
        EXPECT_TRUE(refuses(parseAstm(text.substr(0, size), "cut"), {"astm: cut: line "})) << size;
    }
}

// Found by libFuzzer: a keyword beside the same one in another case among the comments.
TEST(Astm, WritesNoKeywordTwice) {
    const std::string text =
        replaced(smallAstm(), "NUM_POINTS", "COMMENT gonio.astm.lab_Name: x\nNUM_POINTS");
    const std::string once = written(parsed(text));
    const FileRead<BrdfRows> back = parsed(once);
    EXPECT_EQ(back.about.at("astm.LAB_NAME"), "A LABORATORY");
    EXPECT_EQ(back.about.at("astm.lab_Name"), "x");
    EXPECT_EQ(written(back), once);
}

TEST(Astm, IsNotWrittenWithoutARow) {
    BrdfRows rows = test::asymmetricRows();
    for (std::size_t pair = 0; pair < rows.pairs.size(); ++pair) {
        rows.f[rows.index(pair, pair % 3)] = kNan;
    }
    const auto out = writeAstm(rows, {});
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().kind, ErrorKind::Usage);
    EXPECT_EQ(out.error().message, "astm: no direction has a value in every channel");
    EXPECT_FALSE(writeAstm(BrdfRows{}, {}));
}

TEST(Astm, NumbersNamesThatWouldNotComeBack) {
    BrdfRows rows = test::asymmetricRows();
    const auto names = [&](const std::vector<Channel>& channels, std::size_t changed) {
        rows.channels = channels;
        const auto out = writeAstm(rows, {});
        EXPECT_TRUE(out);
        const std::vector<LossReport::Item> lost{{Loss::Clamped, "names of channels", changed}};
        EXPECT_EQ(out->loss.items, changed > 0 ? lost : std::vector<LossReport::Item>{});
        std::vector<std::string> back;
        for (const Channel& channel : parsed(out->bytes).content.channels) {
            back.push_back(channel.name);
        }
        return back;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names({{"a\nb", {}}, {"a b", {}}, {"a_b", {}}}, 3),
              (Names{"a_b", "channel_2_a_b", "channel_3_a_b"}));
    EXPECT_EQ(names({{"BRDF", {}}, {"550nm", {}}, {"x", {}}}, 2),
              (Names{"channel_1_BRDF", "channel_2_550nm", "x"}));
    EXPECT_EQ(names({{}, {}, {"", 550}}, 0), (Names{"channel_1", "channel_2", ""}));
}

}  // namespace
}  // namespace gonio::proc
