#include "proc/formats/alta.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "proc/core/coordinates.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/table/pair_distance.h"
#include "tests/formats/refusal.h"
#include "tests/formats/row_lists.h"
#include "tests/formats/small_files.h"
#include "tests/support/retroreflective.h"

namespace gonio::proc {
namespace {

using test::expectSameRows;
using test::refuses;
using test::replaced;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string smallAlta() {
    return "#SAMPLE \"tape\"\n"
           "#URL https://example.org\n"
           "# a comment\n"
           "#DIM 3 1\n"
           "#VS 0\n"
           "#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n"
           "#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n"
           "0.25  0.5 0   0.125\n"
           "0.25\t0\t-1\t0.5\n";
}

FileRead<BrdfRows> parsed(const std::string& text) {
    auto read = parseAlta(text, "in.dat");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : FileRead<BrdfRows>{};
}
std::string written(const FileRead<BrdfRows>& read) {
    return writeAlta(read.content, read.about)->bytes;
}

TEST(Alta, ReadsTheProjectedForm) {
    const FileRead<BrdfRows> read = parsed(smallAlta());
    const BrdfRows& rows = read.content;
    ASSERT_EQ(rows.pairs.size(), 2U);
    EXPECT_EQ(rows.channels, std::vector<Channel>{Channel{}});
    EXPECT_NEAR(rows.pairs[1].out.theta().value(), 1, 1e-15);
    EXPECT_NEAR(rows.pairs[1].out.phi().value(), 1.5 * kPi, 1e-14);
    EXPECT_NEAR(rows.f[1], 0.5 / std::cos(1.0), 1e-15);
    EXPECT_TRUE(rows.isotropic);
    EXPECT_EQ(read.about.at(key::kSample), "tape");
    EXPECT_EQ(read.about.at("alta.URL"), "https://example.org");
    EXPECT_EQ(read.about.comments, std::vector<std::string>{"a comment"});
}

// Found by libFuzzer: kept as a foreign keyword beside the sample's name, and written as a second
// one.
TEST(Alta, TakesKeywordsInAnyCase) {
    const FileRead<BrdfRows> read =
        parsed(replaced(replaced(smallAlta(), "#SAMPLE", "#SAMPlE"), "#DIM", "#Dim"));
    EXPECT_EQ(read.about.at(key::kSample), "tape");
    EXPECT_EQ(written(parsed(written(read))), written(read));
}

TEST(Alta, WritesForeignKeywordsThatItWouldReadBack) {
    FileRead<BrdfRows> read = parsed(smallAlta());
    for (const char* name : {"alta.Url", "alta.dim", "alta.", "alta.SAMPLE"}) {
        read.about.set(name, "x");
    }
    const std::string once = written(read);
    read.about.values.erase(std::string(key::kCosine));  // said of the first file alone
    EXPECT_EQ(parsed(once).about, read.about);
    EXPECT_EQ(written(parsed(once)), once);
}

TEST(Alta, ReadsTheRealTape) {
    const auto path = test::dataFile("retroreflective/retro-3M-jaune.dat");
    if (!path) return;
    const FileRead<BrdfRows> read = parsed(*readFile(*path));
    const BrdfRows& rows = read.content;
    ASSERT_EQ(rows.pairs.size(), 7397U);
    EXPECT_EQ(read.about.at(key::kSample), "3M Yellow");
    std::vector<double> incidences;
    double least = 1e9, most = 0;
    std::size_t peak = 0;
    for (std::size_t i = 0; i < rows.pairs.size(); ++i) {
        const double theta = rows.pairs[i].in.theta().degrees();
        const auto known = [&](double one) { return std::abs(one - theta) < 1e-6; };
        if (std::none_of(incidences.begin(), incidences.end(), known)) incidences.push_back(theta);
        if (!rows.hasData(i, 0)) continue;
        const double ars = rows.f[i] * rows.pairs[i].out.z();
        least = std::min(least, ars);
        if (ars > most) peak = i;
        most = std::max(most, ars);
    }
    std::sort(incidences.begin(), incidences.end());
    ASSERT_EQ(incidences.size(), 3U);
    EXPECT_NEAR(incidences[0], 15, 1e-9);
    EXPECT_NEAR(incidences[1], 30, 1e-9);
    EXPECT_NEAR(incidences[2], 60, 1e-9);
    // The file's least number, 2.5e-4, stands at the horizon, where it tells no f.
    EXPECT_NEAR(least, 9.6e-4, 0.1e-4);
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_EQ(read.warnings[0].substr(0, 10), "86 values ");
    EXPECT_NEAR(most, 19.3, 0.05);
    // The largest value is no retro-reflection: it stands at the mirror direction of 60 degrees.
    EXPECT_NEAR(rows.pairs[peak].in.theta().degrees(), 60, 1e-9);
    EXPECT_NEAR(rows.pairs[peak].out.theta().degrees(), 59.9, 0.05);
    EXPECT_NEAR(rows.pairs[peak].out.phi().degrees(), 180, 1.5);
    const std::string once = written(read);
    EXPECT_EQ(written(parsed(once)), once);
}

TEST(Alta, AgreesWithAReaderOfItsOwnWay) {
    const std::vector<ScatteredSample> samples = test::retroreflectiveTape();
    const auto path = test::dataFile("retroreflective/retro-3M-jaune.dat");
    if (!path) return;
    const BrdfRows rows = parsed(*readFile(*path)).content;
    std::size_t at = 0, differing = 0;
    for (std::size_t i = 0; i < rows.pairs.size(); ++i) {
        if (!rows.hasData(i, 0)) continue;
        ASSERT_LT(at, samples.size());
        const ScatteredSample& sample = samples[at++];
        const double off = (rows.pairs[i].out.vector() - sample.pair.out.vector()).norm() +
                           (rows.pairs[i].in.vector() - sample.pair.in.vector()).norm();
        // Near the horizon f is the quotient of two small numbers: an ulp of cos there is 1e-13.
        if (off > 1e-15 || !test::near(rows.f[i], sample.f[Band::R], 1e-9)) ++differing;
    }
    EXPECT_EQ(at, samples.size());
    EXPECT_EQ(differing, 0U);
}

TEST(Alta, WritesTheSameBytesAgain) {
    for (BrdfRows rows : {test::asymmetricRows(), test::asymmetricRows(30)}) {
        for (const bool isotropic : {true, false}) {
            rows.isotropic = isotropic;
            Metadata about;
            about.set(key::kSample, "a");
            about.set("alta.ORIGIN", "somewhere");
            about.comments = {"one", "", "  two"};
            const auto made = writeAlta(rows, about);
            ASSERT_TRUE(made);
            const Written& once = *made;
            EXPECT_TRUE(once.loss.items.empty());
            const FileRead<BrdfRows> back = parsed(once.bytes);
            expectSameRows(back.content, rows, 0, 3e-12);  // of coordinates rounded to 1e-12
            EXPECT_EQ(back.about, about);
            EXPECT_EQ(written(back), once.bytes);
        }
    }
    const std::string foreign = written(parsed(smallAlta()));
    EXPECT_EQ(written(parsed(foreign)), foreign);
}

TEST(Alta, HoldsModelsAtNodesAndTheirMirror) {
    for (const char* spec : {"lambert,albedo=0.5", "ggx,alpha=0.05,f0=0.9"}) {
        const BrdfRows rows = test::modelRows(spec);
        const BrdfRows back = parsed(writeAlta(rows, {})->bytes).content;
        expectSameRows(back, rows, 0, 3e-12);
        if (spec[0] == 'g') test::expectPeaksAtTheMirror(back);
    }
}

/// The same pairs in each form: what is read must be them again, up to a common turn.
TEST(Alta, ReadsEachFormOfTheSamePairs) {
    const BrdfRows rows = test::asymmetricRows();
    for (const std::string form : {"ISOTROPIC_TV_TL_DPHI",
                                   "SPHERICAL_TL_PL_TV_PV",
                                   "RUSIN_TH_TD_PD",
                                   "RUSIN_TH_PH_TD_PD",
                                   "CARTESIAN"}) {
        std::string body;
        std::size_t inputs = 0;
        for (const LightView& pair : rows.pairs) {
            std::vector<double> numbers;
            const Direction &in = pair.in, &out = pair.out;
            const auto half = *toHalfDifference({.in = out, .out = in});  // theirs: of the view
            if (form == "ISOTROPIC_TV_TL_DPHI") {
                numbers = {out.theta().value(), in.theta().value(), (-out.phi()).value()};
            } else if (form == "SPHERICAL_TL_PL_TV_PV") {
                numbers = {in.theta().value(), 0, out.theta().value(), out.phi().value()};
            } else if (form == "RUSIN_TH_TD_PD") {
                numbers = {half.thetaHalf.value(), half.thetaDiff.value(), half.phiDiff.value()};
            } else if (form == "RUSIN_TH_PH_TD_PD") {
                numbers = {half.thetaHalf.value(),
                           half.phiHalf.value(),
                           half.thetaDiff.value(),
                           half.phiDiff.value()};
            } else {
                numbers = {out.x(), out.y(), out.z(), in.x(), in.y(), in.z()};
            }
            inputs = numbers.size();
            for (const double n : numbers) body += shortest(n) + " ";
            body += "0.5\n";
        }
        const BrdfRows read = parsed("#DIM " + std::to_string(inputs) + " 1\n#PARAM_IN " + form +
                                     "\n#PARAM_OUT INV_STERADIAN\n" + body)
                                  .content;
        ASSERT_EQ(read.pairs.size(), rows.pairs.size());
        double furthest = 0;
        for (std::size_t i = 0; i < rows.pairs.size(); ++i) {
            furthest = std::max(
                furthest, squaredDistance(read.pairs[i], rows.pairs[i], PairSymmetry::Isotropic));
        }
        EXPECT_LT(furthest, 1e-24) << form;
        EXPECT_TRUE(read.isotropic);
    }
}

TEST(Alta, KeepsChannelsOfAnyKind) {
    for (const std::vector<Channel>& channels :
         {std::vector<Channel>{{"X", {}}, {"Y", {}}, {"Z", {}}},
          std::vector<Channel>{{"", 400}, {"", 500.5}, {"", 600}},
          std::vector<Channel>{{"value 1", {}}, {"value 2", {}}, {"value 3", {}}},
          Channel::ofBands()}) {
        BrdfRows rows = test::asymmetricRows();
        rows.channels = channels;
        const auto made = writeAlta(rows, {});
        ASSERT_TRUE(made);
        const Written& out = *made;
        EXPECT_TRUE(out.loss.items.empty());
        expectSameRows(parsed(out.bytes).content, rows, 0, 3e-12);
    }
}

TEST(Alta, CountsWhatItCannotHold) {
    BrdfRows rows = test::measuredRows();
    rows.channels[0].name = "red";
    rows.f[4] = kNan;
    const auto made = writeAlta(rows, {});
    ASSERT_TRUE(made);
    const Written& out = *made;
    ASSERT_EQ(out.loss.items.size(), 5U);
    EXPECT_EQ(out.loss.items[0].kind, Loss::Masked);
    EXPECT_EQ(out.loss.items[4].what, "names of channels");
    EXPECT_EQ(parsed(out.bytes).content.pairs.size(), rows.pairs.size() - 1);
}

TEST(Alta, LeavesNoValueAtTheHorizonOfACosine) {
    const std::string text = replaced(smallAlta(), "0\t-1\t", "0\t1.570796326794897\t");
    const FileRead<BrdfRows> read = parsed(text);
    EXPECT_FALSE(read.content.hasData(1, 0));
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_NE(read.warnings[0].find("1 values at the horizon"), std::string::npos);
}

TEST(Alta, ReadsAnyLineEndsAndAByteOrderMark) {
    for (const char* end : {"\r\n", "\r"}) {
        std::string text = "\xEF\xBB\xBF";
        for (const char c : smallAlta()) text += c == '\n' ? std::string(end) : std::string(1, c);
        expectSameRows(parsed(text).content, parsed(smallAlta()).content);
        EXPECT_TRUE(
            refuses(parseAlta(replaced(text, "0.125", "x"), "in"), {"alta: in: line 8: 'x'"}));
    }
}

TEST(Alta, SaysWhatIsWrong) {
    const auto refused = [](std::string_view from, std::string_view to) {
        return parseAlta(replaced(smallAlta(), from, to), "in");
    };
    for (const char* word : {"banana", "nan", "inf", "-inf", "1e999", "0x10", "0,5", "1.5.2"}) {
        EXPECT_TRUE(refuses(refused("0.125", word), {"alta: in: line 8: "})) << word;
    }
    EXPECT_TRUE(refuses(refused("0.125", ""), {"line 8: 3 numbers, DIM promised 4"}));
    EXPECT_TRUE(refuses(refused("0.125", "1 2"), {"line 8: 5 numbers, DIM promised 4"}));
    for (const char* dim : {"3", "0 1", "-3 1", "3 0", "3 x", "3 1 1", "99999999999999999999 1"}) {
        EXPECT_TRUE(refuses(refused("DIM 3 1", std::string("DIM ") + dim), {"line 4: DIM "}));
    }
    EXPECT_TRUE(refuses(refused("DIM 3 1", "DIM 4 1"), {"DIM has 4 coordinates"}));
    EXPECT_TRUE(refuses(refused("DIM 3 1", "dimension 3 1"), {"no DIM"}));
    EXPECT_TRUE(refuses(refused("#VS 0", "#VS 2"), {"line 5: VS '2': intervals"}));
    EXPECT_TRUE(refuses(refused("#VS 0", "#Dim 3 1"), {"line 5: 'Dim' is given twice"}));
    EXPECT_TRUE(refuses(refused("ISOTROPIC_TL_TV_PROJ_DPHI", "COS_TH_TD"),
                        {"PARAM_IN 'COS_TH_TD', known are ISOTROPIC_TL"}));
    EXPECT_TRUE(refuses(refused("INV_STERADIAN_COSINE_FACTOR", "ENERGY"),
                        {"PARAM_OUT 'ENERGY', known are INV_STERADIAN"}));
    EXPECT_TRUE(refuses(refused("INV_STERADIAN_COSINE_FACTOR", "RGB_COLOR"),
                        {"DIM has 1 values, RGB_COLOR has 3"}));
    EXPECT_TRUE(refuses(refused("#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n", ""), {"no PARAM_IN"}));
    EXPECT_TRUE(refuses(refused("0.25  0.5", "15  0.5"), {"a theta of '15', wanted radians"}));
    EXPECT_TRUE(refuses(parseAlta(smallAlta() + "#DIM 3 1\n", "in"), {"line 10: the keyword"}));
    EXPECT_TRUE(refuses(parseAlta(smallAlta() + "junk", "in"), {"line 10: 1 numbers"}));
    EXPECT_TRUE(refuses(parseAlta("", "in"), {"alta: in: line 0: no row"}));
    EXPECT_TRUE(refuses(parseAlta("1 2 3 4\n", "in"), {"line 1: no PARAM_IN"}));
}

TEST(Alta, RefusesATextCutWithinItsFirstRow) {
    const std::string text = smallAlta();
    const std::size_t whole = text.find("0.125");
    for (std::size_t size = 0; size <= whole; ++size) {
        EXPECT_TRUE(refuses(parseAlta(text.substr(0, size), "cut"), {"alta: cut: line "})) << size;
    }
}

TEST(Alta, IsNotWrittenWithoutARow) {
    BrdfRows rows = test::asymmetricRows();
    for (std::size_t pair = 0; pair < rows.pairs.size(); ++pair) {
        rows.f[rows.index(pair, pair % 3)] = kNan;
    }
    const auto out = writeAlta(rows, {});
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().kind, ErrorKind::Usage);
    EXPECT_EQ(out.error().message, "alta: no direction has a value in every channel");
    EXPECT_FALSE(writeAlta(BrdfRows{}, {}));
}

}  // namespace
}  // namespace gonio::proc
