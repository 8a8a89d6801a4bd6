// `gonio report` and `gonio albedo` on a .gonio file.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/formats/gonio_exr.h"
#include "tests/daemon/cli/documents.h"
#include "tests/report/html.h"
#include "tests/support/sample_sets.h"

namespace gonio {
namespace {

using Json = nlohmann::json;
using test::documentOf;
using test::Ran;

constexpr double kF = 0.1;  // of red, to 75 degrees of view; green has twice as much

class OnASample : public testing::Test {
protected:
    OnASample() {
        proc::SampleSet set = test::sampleSet([](Radians, const Direction&) { return kF; });
        set.info.name = "<tile> & co";
        EXPECT_TRUE(proc::writeGonio(file, set));
    }
    /// One line on stderr that says all of `words`.
    void expectRefused(const std::vector<std::string>& arguments,
                       int exitCode,
                       const std::vector<std::string>& words) const {
        const Ran ran = gonio(arguments);
        EXPECT_EQ(ran.exitCode, exitCode) << ran.err;
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
        for (const std::string& word : words)
            EXPECT_NE(ran.err.find(word), std::string::npos) << word << " is not in: " << ran.err;
    }
    test::Program gonio;
    const std::string file = (gonio / "tile.gonio").string();
    const std::string page = (gonio / "tile.html").string();
};

TEST_F(OnASample, AReportIsOneWholePage) {
    const Json told = documentOf(
        gonio, {"report", file, "-o", page, "--models", "lambert", "--estimator", "specular-log"});
    EXPECT_EQ(told["file"], page);
    const std::string html = test::textOf(page);
    EXPECT_EQ(told["bytes"], html.size());
    const test::Xml xml = test::readHtml(html);
    EXPECT_EQ(xml.all("h1").at(0).text, "BRDF of <tile> & co");
    const std::string words = test::wordsOf(xml);
    EXPECT_NE(words.find("specular-log"), std::string::npos);
    EXPECT_NE(words.find("chosen"), std::string::npos) << "lambert";
    EXPECT_NE(words.find("tile.gonio"), std::string::npos);
    const auto cells = xml.all("td");
    EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [](const auto& cell) {
        return cell.text.size() == 64 &&
               cell.text.find_first_not_of("0123456789abcdef") == std::string::npos;
    })) << "the file's digest";
}

TEST_F(OnASample, AReportThatCannotBeMadeSaysWhy) {
    constexpr int kUsage = 2, kFile = 6;
    const std::string nowhere = (gonio / "no/folder/o.html").string();
    expectRefused({"report", file, "-o", nowhere}, kFile, {"no folder", "no/folder"});
    expectRefused({"report", file, "-o", gonio / "."}, kFile, {"is a folder"});
    expectRefused({"report", file, "-o", "/dev/full", "--models", "none", "--estimator", "none"},
                  kFile,
                  {"/dev/full"});
    expectRefused({"report", file, "--models", "banana"}, kUsage, {"banana", "lambert"});
    expectRefused({"report", file, "--estimator", "banana"}, kUsage, {"banana", "shepard"});
    expectRefused({"report", "model:lambert,albedo=0.5"}, kUsage, {"is a formula", "sample:NAME"});
    expectRefused({"report", gonio / "none.gonio"}, kFile, {"none.gonio", "no such file"});
    expectRefused({"report", gonio / "."}, kFile, {"not a file"});
    expectRefused({"report", "sample:none"}, kFile, {"store"});
    test::writeText(gonio / "noise.gonio", "this is no OpenEXR file");
    expectRefused({"report", gonio / "noise.gonio"}, kFile, {"noise.gonio", "not an OpenEXR file"});
    const std::string table = GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf";
    expectRefused({"report", table}, kUsage, {"no measured sample", ".gonio"});
}

TEST_F(OnASample, AnAlbedoIsTheSumOverItsCells) {
    const Json rows = documentOf(gonio, {"albedo", file, "--estimator", "none"})["rows"];
    ASSERT_EQ(rows.size(), 5U);
    const double seen = std::pow(std::sin(75 * M_PI / 180), 2);
    for (std::size_t led = 0; led < 4; ++led) {
        const Json& red = rows[led]["bands"]["r"];
        // Floats in the file; 1 % random in some 15,000 cells, 2 % systematic.
        EXPECT_NEAR(red["albedo"], M_PI * kF * seen, 1e-6);
        EXPECT_NEAR(red["u_systematic"], 0.02 * M_PI * kF * seen, 1e-6);
        EXPECT_LT(red["u_random"], 0.01 * 0.02 * M_PI * kF);
        EXPECT_NEAR(red["missing"], 1 - seen, 1e-6);
        EXPECT_NEAR(rows[led]["bands"]["g"]["albedo"], 2 * M_PI * kF * seen, 1e-6);
    }
    expectRefused({"albedo", file, "--estimator", "none", "--incidences", "10"}, 2, {"leave"});
}

TEST_F(OnASample, AnAlbedoIsOfEachRotation) {
    proc::SampleSet set;
    for (const double rotationDeg : {45.0, 90.0}) {
        for (const Radians incidence : {0_deg, 30_deg, 60_deg}) {
            set.leds.push_back(test::ledTable(
                incidence, [&](Radians, const Direction&) { return kF * rotationDeg / 90; }));
            set.leds.back().rotation = Radians::fromDegrees(rotationDeg);
        }
    }
    EXPECT_TRUE(proc::writeGonio(file, set));
    const double seen = std::pow(std::sin(75 * M_PI / 180), 2);
    const Json cells = documentOf(gonio, {"albedo", file, "--estimator", "none"})["rows"];
    ASSERT_EQ(cells.size(), 7U);
    EXPECT_EQ(cells[2]["rotation_deg"], 45);
    EXPECT_EQ(cells[2]["incidence_deg"], 60);
    EXPECT_EQ(cells[5]["rotation_deg"], 90);
    EXPECT_TRUE(cells[6]["rotation_deg"].is_null());
    // At azimuth 0 no rotation stood; the rotations' own have half of it and all.
    const Json asked = documentOf(gonio,
                                  {"albedo",
                                   file,
                                   "--estimator",
                                   "specular-log",
                                   "--incidences",
                                   "30",
                                   "--effort",
                                   "draft"})["rows"];
    ASSERT_EQ(asked.size(), 3U);
    const auto red = [&](std::size_t row) {
        return asked[row]["bands"]["r"]["albedo"].get<double>();
    };
    EXPECT_EQ(asked[1]["rotation_deg"], 90);
    EXPECT_GT(red(1), M_PI * kF * seen);
    EXPECT_NEAR(red(0) / red(1), 0.5, 1e-3);
    EXPECT_NEAR(red(2) / red(1), 0.75, 0.01) << "the mean is over both";

    const Ran shown =
        gonio({"report", file, "-o", page, "--models", "none", "--estimator", "specular-log"});
    EXPECT_EQ(shown.exitCode, 0) << shown.err;
    const std::string html = test::textOf(page);
    EXPECT_NE(html.find("measured at several rotations"), std::string::npos);
    EXPECT_NE(html.find("missing filled in"), std::string::npos) << "by each rotation's own";
}

TEST_F(OnASample, InfoStandsABudgetThatIsNone) {
    proc::SampleSet set;
    set.leds.push_back(test::ledTable(20_deg, [](Radians, const Direction&) { return kF; }));
    for (const char* broken :
         {"banana",
          R"([1,{"led":-1},{"led":0,"band":"x"},{"led":0,"band":"r","components":[3,)"
          R"({"name":"white","median_relative":"x","size":[],"freedom":{}}]}])"}) {
        set.info.budgetJson = broken;
        EXPECT_TRUE(proc::writeGonio(file, set));
        const Json told = documentOf(gonio, {"info", file});
        EXPECT_TRUE(told["budget"].is_array()) << broken;
        const Ran plain = gonio({"info", file});
        EXPECT_EQ(plain.exitCode, 0) << broken << plain.err;
    }
    EXPECT_EQ(documentOf(gonio, {"info", file})["budget"][0]["components"].size(), 1U);
}

}  // namespace
}  // namespace gonio
