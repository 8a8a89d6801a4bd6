// gonio convert, info, atlas on files of all formats, as a user runs them.

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "proc/formats/zemax.h"
#include "tests/daemon/cli/documents.h"
#include "tests/support/data_file.h"
#include "tests/support/json_schema.h"

namespace gonio {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::documentOf;
using test::Program;
using test::Ran;

constexpr const char* kPlastic = "model:lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.3,f0=0.04";
const std::string kEc1 = GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf";

std::string made(const Program& gonio,
                 const std::string& name,
                 const std::vector<std::string>& options = {},
                 const std::string& from = kPlastic) {
    std::vector<std::string> arguments{"convert", from, (gonio / name).string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Ran ran = gonio(arguments);
    EXPECT_EQ(ran.exitCode, 0) << name << ": " << ran.err;
    return (gonio / name).string();
}

void expectRefused(const Program& gonio,
                   const std::vector<std::string>& arguments,
                   int exitCode,
                   const std::vector<std::string>& words) {
    const Ran ran = gonio(arguments);
    EXPECT_EQ(ran.exitCode, exitCode) << ran.err;
    for (const std::string& word : words) {
        EXPECT_NE(ran.err.find(word), std::string::npos) << word << "\n" << ran.err;
    }
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
}

TEST(Convert, WritesEveryFormatAndInfoReadsIt) {
    const Program gonio;
    for (const char* format : {"lighttools",
                               "merl",
                               "rgl",
                               "bird",
                               "astm",
                               "speos",
                               "ssdd",
                               "alta",
                               "csv",
                               "exr-tiles"}) {
        const std::string file = made(gonio, std::string(format) + ".out", {"--to", format});
        const Json facts = documentOf(gonio, {"info", file});
        EXPECT_EQ(facts["kind"], format);
        EXPECT_EQ(test::complaintsOf(facts), "") << format;
        EXPECT_EQ(facts["values"]["channels"].size(), 3U) << format;
    }
}

TEST(Convert, TellsWhatIsLostByKind) {
    const Program gonio;
    const std::string sample = made(gonio, "a.gonio");
    const Json told = documentOf(gonio, {"convert", sample, (gonio / "a.binary").string()});
    EXPECT_EQ(test::complaintsOf(told), "");
    EXPECT_EQ(told["format"], "merl");
    std::map<std::string, Json> kinds;
    for (const Json& one : told["files"][0]["lost"]) kinds[one["kind"]] = one;
    EXPECT_TRUE(kinds.contains("resampled"));
    EXPECT_LT(kinds["resampled"]["weighted_error"], 0.05);
    EXPECT_TRUE(kinds.contains("dropped"));
    const Ran same = gonio({"convert", sample, (gonio / "b.gonio").string()});
    EXPECT_NE(same.err.find("b.gonio: nothing lost"), std::string::npos) << same.err;
}

TEST(Convert, AsksWhatTheFilesDoNotTell) {
    const Program gonio;
    const std::string csv = made(gonio, "a.csv");
    const auto out = [&](const char* name) { return (gonio / name).string(); };
    expectRefused(gonio, {"convert", csv, out("a.brdf")}, 2, {"--to", "bird, speos"});
    expectRefused(gonio, {"convert", csv, out("a.xyz")}, 2, {"--to"});
    expectRefused(gonio, {"convert", csv, out("a.xml")}, 2, {"only read"});
    expectRefused(gonio, {"convert", csv, out("a.bsdf")}, 2, {"--estimator auto"});
    expectRefused(gonio, {"convert", csv, out("a.csv"), "--to", "banana"}, 2, {"banana", "zemax"});
    expectRefused(gonio, {"convert", csv, out("a.json"), "--half"}, 2, {"--half"});
    expectRefused(gonio, {"convert", csv, out("a.json"), "--grid", "/2"}, 2, {"--grid"});
    expectRefused(gonio, {"convert", csv, out("a.json"), "--cosine", "maybe"}, 2, {"yes or no"});
    expectRefused(gonio, {"convert", csv, out("a.json"), "--bands", "x"}, 2, {"--bands"});
    expectRefused(gonio, {"convert", out("none.csv"), out("a.json")}, 6, {"none.csv"});
    const std::string grey = made(gonio, "grey.bsdf", {"--bands", "r"}, made(gonio, "g.gonio"));
    std::string text = test::textOf(grey);
    text.erase(text.find("# Wavelength"),
               text.find('\n', text.find("# Wavelength")) + 1 - text.find("# Wavelength"));
    test::writeText(gonio / "plain.bsdf", text);
    expectRefused(
        gonio, {"convert", out("plain.bsdf"), out("p.gonio")}, 2, {"which band", "--bands"});
    EXPECT_EQ(gonio({"convert", out("plain.bsdf"), out("p.gonio"), "--bands", "g"}).exitCode, 0);
}

TEST(Convert, KeepsTheBandsThatAreNamed) {
    const Program gonio;
    const std::string csv = made(gonio, "a.csv");
    const std::string green = made(gonio, "green.csv", {"--bands", "g"}, csv);
    const Json facts = documentOf(gonio, {"info", green});
    ASSERT_EQ(facts["values"]["channels"].size(), 1U);
    EXPECT_EQ(facts["values"]["channels"][0]["name"], "G");
    const Json two = documentOf(gonio, {"info", made(gonio, "two.gonio", {"--bands", "r,b"}, csv)});
    EXPECT_EQ(two["values"]["channels"].size(), 2U);
}

TEST(Convert, DividesByTheCosineOnRequest) {
    const Program gonio;
    test::writeText(gonio / "cos.csv", "theta_i,phi_i,theta_o,phi_o,f\n10,0,60,0,0.1\n");
    const std::string f = made(gonio, "f.csv", {"--cosine", "yes"}, (gonio / "cos.csv").string());
    EXPECT_NEAR(documentOf(gonio, {"info", f})["values"]["channels"][0]["largest"], 0.2, 1e-12);
}

TEST(Convert, GoesOnToARealCampaignsTable) {
    const auto raw =
        test::dataFile("gonio_rt300s/ANOPLATE_AnoBlack_EC1_Alum6061_v1o0_20251115.RT.csv");
    const auto blank = test::dataFile("gonio_rt300s/blank_v2o0_20250911.RT.csv");
    if (!raw || !blank) GTEST_SKIP();
    const Program gonio;
    const std::string file = made(gonio, "ec1.bsdf", {"--black", blank->string()}, raw->string());
    const auto ours = proc::readZemax(file);
    const auto published = proc::readZemax(kEc1);
    ASSERT_TRUE(ours && published);
    std::vector<double> apart;
    for (std::size_t i = 0; i < published->incidenceDeg.size(); ++i) {
        ASSERT_EQ(ours->incidenceDeg[i], published->incidenceDeg[i]);
        for (const std::size_t side : {std::size_t{0}, published->azimuthDeg.size() - 1}) {
            for (std::size_t r = 0; r < published->radialDeg.size(); ++r) {
                const proc::TableNode there{0, i, side, r};
                const proc::TableNode here{0,
                                           i,
                                           static_cast<std::size_t>(published->azimuthDeg[side]),
                                           static_cast<std::size_t>(published->radialDeg[r])};
                if (!published->hasData(0, there) || !ours->hasData(0, here)) continue;
                const double f = published->planes[0].f[published->index(there)];
                apart.push_back(std::abs(ours->planes[0].f[ours->index(here)] / f - 1));
            }
        }
    }
    ASSERT_GT(apart.size(), 60U);
    std::nth_element(apart.begin(), apart.begin() + 30, apart.end());
    std::sort(apart.begin(), apart.end());
    EXPECT_LT(apart[apart.size() / 2], 0.05);  // 1.6 % seen
    expectRefused(gonio, {"convert", raw->string(), (gonio / "x.bsdf").string()}, 2, {"--black"});
}

TEST(Info, ComparesStatedTotalsWithRecomputedOnes) {
    const Program gonio;
    const Json facts = documentOf(gonio, {"info", kEc1});
    const double physical[] = {0.0507, 0.0494, 0.0499, 0.0818};
    const Json& totals = facts["values"]["totals"];
    ASSERT_EQ(totals.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(totals[i]["recomputed"], physical[i], 0.002 * physical[i]);
    }
    EXPECT_NEAR(totals[0]["stated"], 0.038655, 1e-12);
    bool warned = false;
    for (const std::string warning : facts["values"]["warnings"]) {
        warned = warned || warning.find("stated totals are 0.76 to 1.30") != std::string::npos;
    }
    EXPECT_TRUE(warned) << facts["values"]["warnings"];
}

TEST(Atlas, HoldsSeveralSamples) {
    const Program gonio;
    const std::string file = (gonio / "atlas.exr").string();
    const Json told = documentOf(gonio,
                                 {"atlas",
                                  "-o",
                                  file,
                                  kPlastic,
                                  "model:lambert,albedo=0.5",
                                  "--grid",
                                  "0:30:60/3",
                                  "--half"});
    EXPECT_EQ(test::complaintsOf(told), "");
    EXPECT_TRUE(fs::exists(file));
    expectRefused(gonio, {"info", file}, 2, {"atlas of 2 samples"});
    expectRefused(gonio, {"atlas", "-o", file, (gonio / "none").string()}, 6, {"none"});
}

}  // namespace
}  // namespace gonio
