#include "proc/formats/points_csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/optics/cell_grid.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;
using test::smallPoints;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const std::string kAngleHeader = "theta_i,phi_i,theta_o,phi_o\n";
const std::string kVectorHeader = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n";

Points parsed(std::string_view text) {
    auto points = parsePoints(text, "in.csv");
    EXPECT_TRUE(points) << (points ? "" : points.error().message);
    return points ? std::move(*points) : Points{};
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text.find('\n', at);
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

void expectSame(const Points& a, const Points& b) {
    EXPECT_EQ(a.columns, b.columns);
    EXPECT_EQ(a.rows, b.rows);
    ASSERT_EQ(a.pairs.size(), b.pairs.size());
    for (std::size_t i = 0; i < a.pairs.size(); ++i) {
        EXPECT_EQ(a.pairs[i].in.vector(), b.pairs[i].in.vector());
        EXPECT_EQ(a.pairs[i].out.vector(), b.pairs[i].out.vector());
    }
}

Answer answerOf(LedBands f) {
    Answer answer;
    answer.f = f;
    answer.flags = {Flag::Measured};
    answer.source = Source::Measured;
    return answer;
}

TEST(PointsCsv, ReadsBackTheDirectionsOfBothHeaders) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    std::string angles = kAngleHeader;
    std::string vectors = kVectorHeader;
    std::vector<LightView> pairs;
    const auto add = [](std::string& line, std::initializer_list<double> numbers) {
        for (const double& n : numbers)
            line += shortest(n) + (&n + 1 == numbers.end() ? "\n" : ",");
    };
    for (int i = 0; i < 1000; ++i) {
        const auto any = [&] {
            return Direction::fromSpherical(Radians(kPi * unit(random)),
                                            Radians(2 * kPi * unit(random)));
        };
        const Direction in = any();
        const Direction out = any();
        const double length = std::pow(10.0, 600 * unit(random) - 300);
        pairs.push_back({in, out});
        add(angles,
            {in.theta().degrees(), in.phi().degrees(), out.theta().degrees(), out.phi().degrees()});
        add(vectors,
            {length * in.x(), length * in.y(), length * in.z(), out.x(), out.y(), out.z()});
    }
    const Points fromAngles = parsed(angles);
    const Points fromVectors = parsed(vectors);
    ASSERT_EQ(fromAngles.pairs.size(), pairs.size());
    ASSERT_EQ(fromVectors.pairs.size(), pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        // phi up to 2 pi is good to 4e-16, and goes through degrees and back: 3 roundings.
        EXPECT_LT((fromAngles.pairs[i].in.vector() - pairs[i].in.vector()).norm(), 3e-15);
        EXPECT_LT((fromAngles.pairs[i].out.vector() - pairs[i].out.vector()).norm(), 3e-15);
        EXPECT_LT((fromVectors.pairs[i].in.vector() - pairs[i].in.vector()).norm(), 1e-15);
        EXPECT_LT((fromVectors.pairs[i].out.vector() - pairs[i].out.vector()).norm(), 1e-15);
    }
}

TEST(PointsCsv, PutsNinetyDegreesExactlyOnTheHorizonAndMoreBelowIt) {
    const auto z = [](const char* theta) {
        return parsed(kAngleHeader + theta + ",77,0,0\n").pairs.at(0).in.z();
    };
    EXPECT_EQ(z("90"), 0);
    EXPECT_EQ(z("90.0"), 0);
    EXPECT_GT(z("89.99999999999999"), 0);
    EXPECT_LT(z("90.00000000000003"), 0);
    EXPECT_EQ(z("180"), -1);
    EXPECT_EQ(z("0"), 1);
    EXPECT_EQ(z("-0"), 1);
}

TEST(PointsCsv, TakesAnyAzimuthAndRefusesPolarAnglesOutside) {
    const Points points = parsed(kAngleHeader + "30,-90,40,630\n");
    EXPECT_NEAR(points.pairs[0].in.y(), -0.5, 1e-15);
    EXPECT_NEAR(points.pairs[0].out.y(), -std::sin(40 * kPi / 180), 3e-15);  // 3.5 pi: 4 ulp
    for (const char* row : {"-1,0,0,0", "180.1,0,0,0", "0,0,-0.001,0", "0,0,181,0"}) {
        EXPECT_TRUE(refuses(parsePoints(kAngleHeader + row, "in"),
                            {"csv: in: line 2: theta_", "wanted degrees in [0, 180]"}));
    }
}

TEST(PointsCsv, RefusesAVectorWithoutALength) {
    EXPECT_TRUE(refuses(parsePoints(kVectorHeader + "0,0,0,0,0,1\n", "in"),
                        {"csv: in: line 2: wi has no length"}));
    EXPECT_TRUE(
        refuses(parsePoints(kVectorHeader + "0,0,1,0,-0,0\n", "in"), {"line 2: wo has no length"}));
}

TEST(PointsCsv, TakesTheColumnsInAnyOrderAndCarriesTheOthers) {
    const Points points = parsed("id,phi_o, theta_o ,x,\"phi_i\",theta_i\nA,180,30,,0,20\n");
    EXPECT_EQ(points.columns,
              (std::vector<std::string>{"id", "phi_o", "theta_o", "x", "phi_i", "theta_i"}));
    EXPECT_EQ(points.rows, std::vector<std::string>{"A,180,30,,0,20"});
    expectSame({points.columns, points.rows, parsed(kAngleHeader + "20,0,30,180").pairs}, points);
}

TEST(PointsCsv, ReadsQuotedFieldsWithCommas) {
    const Points points = parsed(smallPoints());
    EXPECT_EQ(points.columns.back(), "name, or none");
    EXPECT_EQ(points.rows.at(1), "30,0,30,180,\"mirror, exact\"");
    const Points spaced = parsed(replaced(smallPoints(), "30,0,30", " \"30\" ,\t0,\" 30 \""));
    expectSame({points.columns, points.rows, spaced.pairs}, points);
}

TEST(PointsCsv, RefusesAQuotedFieldThatDoesNotEndOnItsLine) {
    for (const char* line : {"a,\"b,theta_i,phi_i,theta_o,phi_o\n",
                             "theta_i,phi_i,theta_o,phi_o,a\"\n",
                             "theta_i,phi_i,theta_o,phi_o,a\n1,2,3,4,\"b\n"}) {
        EXPECT_TRUE(refuses(parsePoints(line, "in"), {"csv: in: line "}));
    }
    EXPECT_TRUE(
        refuses(parsePoints("theta_i,phi_i,theta_o,phi_o,a\n1,2,3,4,\"b\n5,6,7,8,c\"", "in"),
                {"line 2: a quoted field does not end on its line"}));
}

TEST(PointsCsv, SkipsTheByteOrderMarkEmptyLinesAndComments) {
    const std::string text =
        "\xEF\xBB\xBF\n# one\n  # two\n" + kAngleHeader + "\n \t\n1,2,3,4\n#\n";
    expectSame(parsed(text), parsed(kAngleHeader + "1,2,3,4"));
}

TEST(PointsCsv, TakesEveryLineEndAndCountsIt) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const char c : replaced(smallPoints(), "60,10", "60,banana")) {
            text += c == '\n' ? std::string(end) : std::string(1, c);
        }
        EXPECT_TRUE(refuses(parsePoints(text, "in.csv"),
                            {"csv: in.csv: line 6: phi_i: 'banana', wanted a number"}));
        expectSame(parsed(replaced(text, "banana", "10")), parsed(smallPoints()));
    }
}

TEST(PointsCsv, RefusesWhatIsNoFiniteNumber) {
    for (const char* word : {"banana", "nan", "inf", "-inf", "1e999", "0x10", "1.5.2", "", "1 2"}) {
        for (const char* row : {"@,0,0,0", "0,@,0,0", "0,0,@,0", "0,0,0,@"}) {
            EXPECT_TRUE(refuses(parsePoints(kAngleHeader + replaced(row, "@", word), "in"),
                                {"csv: in: line 2: ", std::string("'") + word + "'"}));
        }
    }
}

TEST(PointsCsv, RefusesRowsOfAnotherLengthThanTheHeader) {
    EXPECT_TRUE(refuses(parsePoints(kAngleHeader + "1,2,3\n", "in"),
                        {"line 2: 3 fields, the header has 4"}));
    EXPECT_TRUE(refuses(parsePoints(kAngleHeader + "1,2,3,4,\n", "in"),
                        {"line 2: 5 fields, the header has 4"}));
}

TEST(PointsCsv, RefusesAHeaderWithoutOneKindOfDirections) {
    EXPECT_TRUE(refuses(parsePoints("", "in"), {"csv: in: ", "no header", "theta_i", "wi_x"}));
    EXPECT_TRUE(refuses(parsePoints("# only this\n", "in"), {"no header"}));
    EXPECT_TRUE(refuses(parsePoints("theta_i,phi_i,theta_o\n1,2,3\n", "in"),
                        {"line 1: no directions", "theta_i,phi_i,theta_o,phi_o"}));
    EXPECT_TRUE(refuses(parsePoints("theta_i,phi_i,theta_o,phi_o," + kVectorHeader, "in"),
                        {"line 1: both kinds"}));
    EXPECT_TRUE(refuses(parsePoints("phi_i,theta_i,phi_i,theta_o,phi_o\n", "in"),
                        {"line 1: column phi_i is there twice"}));
    EXPECT_TRUE(refuses(parsePoints("Theta_I,phi_i,theta_o,phi_o\n", "in"), {"no directions"}));
}

TEST(PointsCsv, SurvivesATextCutAtAnyByte) {
    const std::string text = smallPoints();
    for (std::size_t size = 0; size < text.size(); ++size) {
        const auto points = parsePoints(text.substr(0, size), "cut.csv");
        if (points) {
            EXPECT_EQ(points->pairs.size(), points->rows.size());
        } else {
            EXPECT_TRUE(refuses(points, {"csv: cut.csv: line "}));
        }
    }
}

TEST(PointsCsv, NamesTheFileThatItCannotRead) {
    const test::TempFolder folder;
    EXPECT_TRUE(refuses(readPoints(folder / "none.csv"), {"none.csv: no such file"}));
    ASSERT_TRUE(writeFile(folder / "in.csv", smallPoints()));
    const auto points = readPoints(folder / "in.csv");
    ASSERT_TRUE(points);
    expectSame(*points, parsed(smallPoints()));
}

TEST(EvalCsv, ReadsBackAsTheSamePointsAndTheShortestDigits) {
    const Points points = parsed(smallPoints());
    std::vector<Answer> answers(3, answerOf({{0.1, 1.0 / 3, 1e-300}}));
    answers[2] = Answer::none({Flag::BelowHorizon}, Source::Analytic);
    const std::string text = evalCsv(points, answers, BandCount::Three);
    EXPECT_EQ(linesOf(text),
              (std::vector<std::string>{
                  "theta_i,phi_i,theta_o,phi_o,\"name, or none\",f_r,f_g,f_b,flags,source",
                  "0,0,45,90,normal,0.1,0.3333333333333333,1e-300,1,measured",
                  "30,0,30,180,\"mirror, exact\",0.1,0.3333333333333333,1e-300,1,measured",
                  "60,10,90,190,horizon,,,,16,analytic"}));
    const Points back = parsed(text);
    expectSame({points.columns, points.rows, back.pairs}, points);
}

TEST(EvalCsv, HasOneColumnForAMonochromeFile) {
    const Points points = parsed(kAngleHeader + "0,0,0,0");
    const std::vector<Answer> answers{answerOf(LedBands::all(0.25))};
    EXPECT_EQ(evalCsv(points, answers, BandCount::One),
              "theta_i,phi_i,theta_o,phi_o,f,flags,source\n0,0,0,0,0.25,1,measured\n");
}

TEST(EvalCsv, CombinesTheUncertaintiesWhereAnyAnswerKnowsThem) {
    const Points points = parsed(kAngleHeader + "0,0,0,0\n1,0,0,0\n2,0,0,0\n3,0,0,0\n");
    std::vector<Answer> answers(4, answerOf(LedBands::all(1)));
    answers[1].uRandom = LedBands{{3, 0.5, kNan}};
    answers[1].uSystematic = LedBands{{4, 0, 1}};
    answers[2].uSystematic = LedBands::all(2);
    answers[3].uRandom = LedBands::all(0.5);
    EXPECT_EQ(linesOf(evalCsv(points, answers, BandCount::Three)),
              (std::vector<std::string>{
                  "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b,u_r,u_g,u_b,flags,source",
                  "0,0,0,0,1,1,1,,,,1,measured",
                  "1,0,0,0,1,1,1,5,0.5,,1,measured",
                  "2,0,0,0,1,1,1,2,2,2,1,measured",
                  "3,0,0,0,1,1,1,0.5,0.5,0.5,1,measured"}));
    EXPECT_EQ(linesOf(evalCsv(points, answers, BandCount::One))[2], "1,0,0,0,1,5,1,measured");
}

TEST(EvalCsv, KeepsAnInputColumnOfTheSameNameAsInput) {
    const Points points = parsed("theta_i,phi_i,theta_o,phi_o,f_r,f,flags,u_r\n0,0,0,0,9,8,7,6");
    const std::vector<Answer> answers{answerOf(LedBands::all(0.5))};
    EXPECT_EQ(
        linesOf(evalCsv(points, answers, BandCount::Three)),
        (std::vector<std::string>{
            "theta_i,phi_i,theta_o,phi_o,input_f_r,f,input_flags,u_r,f_r,f_g,f_b,flags,source",
            "0,0,0,0,9,8,7,6,0.5,0.5,0.5,1,measured"}));
    EXPECT_EQ(linesOf(evalCsv(points, answers, BandCount::One))[0],
              "theta_i,phi_i,theta_o,phi_o,f_r,input_f,input_flags,u_r,f,flags,source");
}

TEST(EvalCsv, QuotesAColumnThatWouldReadAsTwoOrAsAComment) {
    const Points points =
        parsed("\"#id\",\"a,\"\"b\"\"\",c\"d,e\"f,theta_i,phi_i,theta_o,phi_o\n1,2,3,0,0,0,0\n");
    const std::vector<Answer> answers{answerOf(LedBands::all(0.5))};
    const Points back = parsed(evalCsv(points, answers, BandCount::One));
    ASSERT_EQ(back.columns.size(), 10U);
    EXPECT_EQ(back.columns[0], "#id");
    EXPECT_EQ(back.columns[1], "a,\"b\"");
    EXPECT_EQ(back.columns[2], "c\"d,e\"f");
}

TEST(EvalCsv, IsItsHeaderAloneWithoutPoints) {
    EXPECT_EQ(evalCsv(parsed(kVectorHeader), {}, BandCount::One),
              "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f,flags,source\n");
}

}  // namespace
}  // namespace gonio::proc
