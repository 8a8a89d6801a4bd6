// Commands that ask files between and beyond what was measured.

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/daemon/cli/documents.h"

namespace gonio {
namespace {

using Json = nlohmann::json;
using test::documentOf;
using test::Program;
using test::Ran;

constexpr const char* kSurface = "model:lambert,albedo=0.3+ggx,alpha=0.2,f0=0.04";

/// A Zemax file of the surface at the LEDs' incidences.
std::filesystem::path tableFile(const Program& gonio) {
    const std::filesystem::path file = gonio / "surface.bsdf";
    const Ran ran = gonio({"convert", kSurface, file.string()});
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    return gonio / "surface_R.bsdf";
}

std::filesystem::path pointsFile(const Program& gonio) {
    const std::filesystem::path file = gonio / "points.csv";
    test::writeText(file,
                    "theta_i,phi_i,theta_o,phi_o\n20,0,30,180\n30,0,40,150\n70,0,20,90\n"
                    "40,0,100,0\n");
    return file;
}

/// f and source of each row of `eval`.
std::vector<std::pair<std::string, std::string>> evaluated(const Program& gonio,
                                                           std::vector<std::string> arguments) {
    const Ran ran = gonio(arguments);
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    std::istringstream lines(ran.out);
    std::string line;
    std::getline(lines, line);
    std::vector<std::pair<std::string, std::string>> rows;
    while (std::getline(lines, line)) {
        std::vector<std::string> fields;
        std::istringstream row(line);
        for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
        if (fields.size() > 4) rows.emplace_back(fields[4], fields.back());
    }
    return rows;
}

TEST(EvalEstimator, AnswersBetweenAndBeyondAndSaysWhereFrom) {
    const Program gonio;
    const std::string table = tableFile(gonio).string();
    const std::string points = pointsFile(gonio).string();
    const auto truth = evaluated(gonio, {"eval", kSurface, "--points", points});
    const auto ours = evaluated(gonio, {"eval", table, "--points", points});
    ASSERT_EQ(ours.size(), 4U);
    EXPECT_EQ(ours[0].second, "measured");
    EXPECT_NE(ours[1].second, "measured");
    for (std::size_t i = 0; i < 3; ++i) {
        const double f = std::stod(truth[i].first);
        EXPECT_NEAR(std::stod(ours[i].first), f, 0.02 * f) << i;
    }
    EXPECT_EQ(ours[3].first, "");  // below the horizon
    const auto plain = evaluated(gonio, {"eval", table, "--points", points, "--estimator", "none"});
    EXPECT_EQ(plain[2].first, "");  // 70 degrees was not measured
    const auto seed =
        evaluated(gonio, {"eval", table, "--points", points, "--estimator", "axis-linear"});
    EXPECT_EQ(seed[2].second, "extrapolated");
    const auto ending =
        evaluated(gonio, {"eval", table, "--points", points, "--estimator", "axis-linear:none"});
    EXPECT_EQ(ending[2].first, "") << "70 degrees lie beyond";
    EXPECT_EQ(ending[1].first, seed[1].first);
}

TEST(EvalEstimator, KrigesScatteredValues) {
    const Program gonio;
    std::ostringstream csv;
    csv << "theta_i,phi_i,theta_o,phi_o,f\n";
    for (const int thetaI : {0, 30, 60}) {
        for (int thetaO = 5; thetaO < 80; thetaO += 12) {
            for (int phi = 0; phi < 360; phi += 45) {
                csv << thetaI << ",0," << thetaO << "," << phi << "," << 0.1 + 1e-3 * thetaI
                    << "\n";
            }
        }
    }
    test::writeText(gonio / "scattered.csv", csv.str());
    const auto rows = evaluated(
        gonio,
        {"eval", (gonio / "scattered.csv").string(), "--points", pointsFile(gonio).string()});
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_NEAR(std::stod(rows[1].first), 0.13, 0.02);
    EXPECT_TRUE(rows[1].second == "interpolated" || rows[1].second == "model") << rows[1].second;
    // Their own incidences, without being told how to ask them.
    const Ran compared = gonio(
        {"--json", "compare", (gonio / "scattered.csv").string(), "model:lambert,albedo=0.4"});
    ASSERT_EQ(compared.exitCode, 0) << compared.err;
    const Json differences = Json::parse(compared.out);
    EXPECT_EQ(test::complaintsOf(differences), "");
    EXPECT_EQ(differences["rows"].back()["incidence_deg"], 60) << "no 59.99999999999999";
    EXPECT_GT(differences["rows"][0]["values"].get<int>(), 10000);
}

TEST(EvalEstimator, RefusesWhatCannotBe) {
    const Program gonio;
    const std::string points = pointsFile(gonio).string();
    const std::string table = tableFile(gonio).string();
    const Ran unknown = gonio({"eval", table, "--points", points, "--estimator", "banana"});
    EXPECT_EQ(unknown.exitCode, 2);
    EXPECT_NE(unknown.err.find("carried:lambert+ggx"), std::string::npos) << unknown.err;
    EXPECT_NE(unknown.err.find(":bezier"), std::string::npos) << unknown.err;
    const Ran formula = gonio({"eval", kSurface, "--points", points, "--estimator", "prior"});
    EXPECT_EQ(formula.exitCode, 2);
    test::writeText(gonio / "library.txt", "banana\n");
    const Ran library =
        gonio({"eval", table, "--points", points, "--prior", (gonio / "library.txt").string()});
    EXPECT_EQ(library.exitCode, 6);
    EXPECT_NE(library.err.find("line 1"), std::string::npos) << library.err;
    test::writeText(gonio / "few.csv", "theta_i,phi_i,theta_o,phi_o,f\n0,0,10,0,0.1\n");
    const Ran few = gonio({"eval", (gonio / "few.csv").string(), "--points", points});
    EXPECT_EQ(few.exitCode, 7) << few.err;
}

TEST(Compare, TellsWhetherSurfacesAgree) {
    const Program gonio;
    const Ran ran =
        gonio({"--json", "compare", "model:lambert,albedo=0.33", "model:lambert,albedo=0.3"});
    ASSERT_EQ(ran.exitCode, 0) << ran.err;
    const Json json = Json::parse(ran.out);
    EXPECT_EQ(test::complaintsOf(json), "");
    EXPECT_EQ(json["agreement"], "unknown");
    EXPECT_NEAR(json["rows"][0]["relative_rms"].get<double>(), 0.1, 1e-9);
    EXPECT_EQ(json["rows"].size(), 4U * 4 * 3);
    const Ran shown =
        gonio({"compare", tableFile(gonio).string(), kSurface, "--incidences", "22.5,50"});
    EXPECT_EQ(shown.exitCode, 0) << shown.err;
    EXPECT_NE(shown.out.find("cannot be said"), std::string::npos) << shown.out;
    EXPECT_NE(shown.out.find("22.5 "), std::string::npos) << shown.out;
    const Ran bad = gonio({"compare", kSurface, kSurface, "--incidences", "30,x"});
    EXPECT_EQ(bad.exitCode, 2);
    EXPECT_NE(bad.err.find("'x'"), std::string::npos) << bad.err;
    const Ran nothing =
        gonio({"compare", tableFile(gonio).string(), kSurface, "--incidences", "80"});
    EXPECT_EQ(nothing.exitCode, 7) << nothing.err;
}

TEST(Albedo, OfAModelIsExactAndOfATableWhatItIs) {
    const Program gonio;
    const Json lambert =
        documentOf(gonio, {"albedo", "model:lambert,albedo=0.5", "--incidences", "0,70"});
    ASSERT_EQ(lambert["rows"].size(), 3U);
    for (const Json& row : lambert["rows"]) {
        EXPECT_NEAR(row["bands"]["g"]["albedo"].get<double>(), 0.5, 1e-6);
        EXPECT_NEAR(row["bands"]["g"]["missing"].get<double>(), 0, 1e-9);
        EXPECT_TRUE(row["converged"].get<bool>());
        EXPECT_GE(row["evaluations"].get<int>(), 5400);
    }
    const Ran cheap = gonio(
        {"albedo", "model:ggx,f0=1,alpha=0.001", "--incidences", "89.9", "--effort", "draft"});
    EXPECT_NE(cheap.out.find("5400"), std::string::npos) << cheap.out;
    EXPECT_NE(cheap.out.find("converged"), std::string::npos) << cheap.out;
    EXPECT_EQ(gonio({"albedo", "model:ggx,f0=1,alpha=0.1", "--effort", "banana"}).exitCode, 2);
    EXPECT_TRUE(lambert["rows"][2]["incidence_deg"].is_null());
    const Ran bad = gonio({"albedo", "model:lambert,albedo=0.5", "--incidences", "95"});
    EXPECT_EQ(bad.exitCode, 2);
    EXPECT_NE(bad.err.find("'95'"), std::string::npos) << bad.err;
}

TEST(TradeLookup, TellsErrorsBytesAndTimes) {
    const Program gonio;
    const std::filesystem::path folder = gonio / "out";
    const Json rows =
        documentOf(gonio, {"trade", "lookup", "--quick", "-o", folder.string()})["rows"];
    EXPECT_GT(rows.size(), 6U);
    EXPECT_LT(rows[0]["draw_variance"].get<double>(),
              rows[0]["draw_variance_by_cosine"].get<double>());
    EXPECT_GT(test::textOf(folder / "trade-lookup.md").size(), 500U);
    const std::string picture = test::textOf(folder / "trade-lookup.svg");
    EXPECT_EQ(picture.find("<svg"), 0U);
    for (const Json& row : rows) {
        const std::string material = row["material"];
        EXPECT_NE(picture.find(">" + material + "<"), std::string::npos) << material;
    }
}

TEST(TradeNeighbours, TellsCostsByNumber) {
    const Program gonio;
    const std::filesystem::path folder = gonio / "out";
    const Json rows =
        documentOf(gonio, {"trade", "neighbours", "--quick", "-o", folder.string()})["rows"];
    EXPECT_EQ(rows.size(), 3U);
    EXPECT_GT(test::textOf(folder / "trade-neighbours.svg").size(), 1000U);
}

TEST(PriorBuild, WritesALibraryThatReadsBack) {
    const Program gonio;
    const std::string file = (gonio / "library.txt").string();
    const Ran ran = gonio({"--json", "prior", "build", "--count", "60", "-o", file});
    ASSERT_EQ(ran.exitCode, 0) << ran.err;
    const Json json = Json::parse(ran.out);
    EXPECT_EQ(test::complaintsOf(json), "");
    EXPECT_EQ(json["materials"], 60);
    const std::string points = pointsFile(gonio).string();
    const auto rows = evaluated(gonio,
                                {"eval",
                                 tableFile(gonio).string(),
                                 "--points",
                                 points,
                                 "--estimator",
                                 "prior",
                                 "--prior",
                                 file});
    const auto truth = evaluated(gonio, {"eval", kSurface, "--points", points});
    ASSERT_EQ(rows.size(), 4U);
    for (const std::size_t between : {1U, 2U}) {
        const double f = std::stod(truth[between].first);
        EXPECT_EQ(rows[between].second, "prior");
        EXPECT_NEAR(std::stod(rows[between].first), f, 0.01 * f);
        EXPECT_NE(rows[between].first, truth[between].first);
    }
    EXPECT_EQ(gonio({"prior", "build", "--fits", file, "-o", file}).exitCode, 6);
}

}  // namespace
}  // namespace gonio
