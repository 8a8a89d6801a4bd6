// Commands that need no rig: what the models err by and cost, and their fit to a file of values.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/daemon/cli/program.h"
#include "tests/support/json_schema.h"

namespace gonio {
namespace {

using Json = nlohmann::json;
using test::Program;
using test::Ran;

Json jsonOf(const Program& gonio, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "--json");
    const Ran ran = gonio(arguments);
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    Json json = Json::parse(ran.out, nullptr, false);
    EXPECT_FALSE(json.is_discarded()) << ran.out;
    EXPECT_EQ(test::complaintsOf(json), "");
    return json;
}

TEST(TradePowers, TellsErrorsTimesAndWhatReproduces) {
    const Program gonio;
    const std::filesystem::path folder = gonio / "powers";
    const Json all = jsonOf(gonio, {"trade", "powers", "--quick", "-o", folder.string()});
    EXPECT_NEAR(all["regression"]["rms"].get<double>(), 0, 0.05);
    std::vector<std::string> forms;
    for (const Json& row : all["errors"]) forms.push_back(row["form"]);
    for (const char* form : {"schlick",
                             "bps",
                             "f8",
                             "quadratic",
                             "cubic",
                             "gauss",
                             "lagarde",
                             "sq8",
                             "sq8d3",
                             "rec2m4",
                             "rec3m4",
                             "lite",
                             "full54",
                             "full75"}) {
        EXPECT_EQ(std::count(forms.begin(), forms.end(), form), 2) << form;  // float and double
    }
    for (const Json& row : all["times"]) EXPECT_GT(row["ns"].get<double>(), 0) << row;
    EXPECT_GT(test::textOf(folder / "trade-powers.csv").size(), 1000U);
    EXPECT_GT(test::textOf(folder / "trade-powers.md").size(), 1000U);
}

TEST(TradeNumerics, HoldsItsGoalsByATableOfTheRepository) {
    const Program gonio;
    // One of them: tests/models looks at all.
    std::filesystem::copy(GONIO_SOURCE_DIR "/tests/reference/d_ggx.csv", gonio / "d_ggx.csv");
    const Json all = jsonOf(gonio, {"trade", "numerics", "--reference", (gonio / ".").string()});
    const Json& ggx = all["tables"]["d_ggx"]["D"];
    EXPECT_LE(ggx["float"], 5e-7);
    EXPECT_LE(ggx["double"], 1e-14);
    EXPECT_GT(ggx["float"], 0);
}

/// At four incidences, in one band.
std::string lambertian(double f, double u) {
    std::ostringstream csv;
    csv << "theta_i,phi_i,theta_o,phi_o,f,u\n";
    for (const int thetaI : {0, 20, 40, 60}) {
        for (int thetaO = 5; thetaO < 75; thetaO += 5) {
            for (int phi = 0; phi < 360; phi += 30) {
                const double noise = std::sin(thetaI + 13.7 * thetaO + 3.1 * phi);  // bounded
                csv << thetaI << ",0," << thetaO << "," << phi << "," << f + u * noise << "," << u
                    << "\n";
            }
        }
    }
    return csv.str();
}

TEST(Fit, NamesTheSimplestModelOfAFileOfValues) {
    const Program gonio;
    const std::filesystem::path file = gonio / "matt.csv";
    test::writeText(file, lambertian(0.1, 1e-3));
    const std::filesystem::path folder = gonio / "report";
    const Json all = jsonOf(gonio,
                            {"fit",
                             file.string(),
                             "--models",
                             "oren-nayar,lambert+ggx,lambert",
                             "-o",
                             folder.string()});
    EXPECT_EQ(all["chosen"], "lambert");
    EXPECT_EQ(all["values"], 4 * 14 * 12);
    for (const Json& model : all["models"]) {
        if (model["model"] != "lambert") continue;
        EXPECT_NEAR(model["parameters"][0]["value"].get<double>(), 0.1 * M_PI, 2e-4 * M_PI);
    }
    for (const char* name : {"fit.json", "fit.md", "residuals.csv", "residuals.svg"}) {
        EXPECT_GT(test::textOf(folder / name).size(), 300U) << name;
    }
    const Ran shown = gonio({"fit", file.string(), "--models", "lambert"});
    EXPECT_EQ(shown.exitCode, 0) << shown.err;
    EXPECT_NE(shown.out.find("lambert is the simplest"), std::string::npos) << shown.out;
}

TEST(Fit, ValuesThatSayNothingAreNoCrash) {
    const Program gonio;
    const std::string head = "theta_i,phi_i,theta_o,phi_o,f,u\n";
    const std::filesystem::path file = gonio / "poor.csv";
    for (const char* rows : {"", "0,0,10,0,nan,1\n", "0,0,10,0,0.1,0\n", "0,0,95,0,0.1,0.01\n"}) {
        test::writeText(file, head + rows);
        const Ran ran = gonio({"fit", file.string(), "--models", "all"});
        EXPECT_EQ(ran.exitCode, 6) << rows << ran.err;
        EXPECT_NE(ran.err.find("poor.csv"), std::string::npos) << ran.err;
    }
    for (const char* rows : {"0,0,10,0,0.1,0.01\n",
                             "0,0,10,0,-5,1\n20,0,10,0,-5,1\n20,0,30,0,-4,1\n",
                             "0,0,10,0,1e300,1\n0,0,20,0,1e300,1\n0,0,30,0,-1e300,1\n",
                             "0,0,10,0,1,1e-300\n0,0,20,0,2,1e-300\n0,0,30,0,1,1e-300\n"}) {
        test::writeText(file, head + rows);
        const Ran ran = gonio({"fit", file.string(), "--models", "all"});
        EXPECT_EQ(ran.exitCode, 0) << rows << ran.err;
        for (const char* nonsense : {"inf", "nan"}) {
            EXPECT_EQ(ran.out.find(nonsense), std::string::npos) << rows << ran.out;
        }
    }
}

}  // namespace
}  // namespace gonio
