// Whole measurements as a user makes them: calibrate, measure, look, export, on the simulated rig.

#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/daemon/cli/lab_bench.h"
#include "tests/support/data_file.h"

namespace gonio {
namespace {

using Json = nlohmann::json;
using test::Bench;
using test::expectAccurate;
using test::Ran;

const std::vector<std::string> kSamples{
    GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf",
    "model:oren-nayar,albedo=0.8,sigma=0.3",
    "model:lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04",
    "model:ggx,alpha=0.05,f0=0.9/0.7/0.4",
};

/// What was planned from the pilots came true: within a tenth of the random uncertainty and of the
/// time.
void expectAsPlanned(const Json& measured) {
    const Json& planned = measured["planned"];
    const Json& achieved = measured["achieved"];
    for (const char* share : {"median", "p95"}) {
        const double wanted = planned["random"][share];
        EXPECT_NEAR(achieved["random"][share], wanted, 0.1 * wanted) << measured;
    }
    const double seconds = planned["seconds"];
    EXPECT_NEAR(achieved["seconds"], seconds, 0.1 * seconds) << measured;
    // Cells that more frames would hardly help are held above what was wanted.
    EXPECT_LE(planned["random"]["worst"].get<double>(), 1.1 * planned["wanted"].get<double>());
    EXPECT_NEAR(achieved["cells"], planned["cells"], 0.02 * planned["cells"].get<double>());
}

/// Measures all samples: the score of each, and what `measure` said.
struct Measured {
    Json scores;
    std::vector<Json> runs;
};
Measured measureAll(const Bench& gonio) {
    Measured all;
    std::vector<std::string> score{"sim", "score"};
    for (std::size_t i = 0; i < kSamples.size(); ++i) {
        const std::string name = "s" + std::to_string(i);
        gonio({"sim", "place", kSamples[i]});
        const Json measured = gonio({"measure", name});
        EXPECT_EQ(measured["schema"], "gonio/measure/1");
        EXPECT_NEAR(measured["chi_square_per_freedom"], 1, 0.01);
        expectAsPlanned(measured);
        score.push_back(measured["file"]);
        all.runs.push_back(measured);
    }
    all.scores = gonio(score)["samples"];
    return all;
}

/// A measured sample can be looked at, evaluated, exported and plotted, and says the same each
/// time.
/// `measured` is what `measure` said of it.
void expectUsable(const Bench& gonio, const Json& measured) {
    const Json info = gonio({"info", "sample:s1"});
    EXPECT_EQ(info["schema"], "gonio/info/1");
    ASSERT_EQ(info["leds"].size(), 4U);
    // At normal incidence Oren-Nayar is (albedo / pi) A, A = 1 - sigma^2 / (2 sigma^2 + 0.66);
    // within 75 degrees lie sin^2(75) of its light. 0.2 % for noise and lens.
    const double expected = 0.8 * (1 - 0.09 / 0.84) * std::pow(std::sin(75 * M_PI / 180), 2);
    EXPECT_NEAR(
        info["leds"][0]["g"]["reflected_fraction_within_measured"], expected, 0.002 * expected);
    test::writeText(gonio.program / "points.csv",
                    "theta_i,phi_i,theta_o,phi_o\n0,0,30,40\n20,0,30,40\n60,0,80,0\n20,0,95,0\n");
    const Ran eval = gonio.program({"eval", "sample:s1", "--points", gonio.program / "points.csv"});
    EXPECT_EQ(eval.exitCode, 0) << eval.err;
    EXPECT_EQ(eval.out.find("theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b,u_r,u_g,u_b,flags,source\n"),
              0U)
        << eval.out;

    const std::string bsdf = gonio.program / "s1.bsdf";
    EXPECT_EQ(gonio({"convert", "sample:s1", bsdf})["files"].size(), 3U);
    const Json zemax = gonio({"info", (gonio.program / "s1_G.bsdf").string()});
    EXPECT_EQ(zemax["kind"], "zemax");
    EXPECT_EQ(zemax["incidences_deg"], (std::vector<double>{0, 20, 40, 60}));
    EXPECT_EQ(zemax["azimuths"], 361);
    EXPECT_EQ(zemax["radials"], 181);

    const std::string copy = gonio.program / "copy.gonio";
    gonio({"convert", "sample:s1", copy});
    EXPECT_EQ(test::textOf(copy), test::textOf(measured["file"].get<std::string>()));

    const Json raw = gonio({"info", measured["raw"]});
    ASSERT_EQ(raw["states"].size(), 12U);
    EXPECT_EQ(raw["about"]["name"], "s1");
    EXPECT_GE(raw["states"][0]["bracket"].size(), 2U);

    const Json plots = gonio({"plot", "sample:s1", "-o", gonio.program / "plots"});
    ASSERT_EQ(plots["files"].size(), 2U);
    for (const std::string file : plots["files"]) {
        EXPECT_EQ(test::textOf(file).find("<svg"), 0U) << file;
    }
}

/// A sample worked out again is the same to the last bit with its own calibration, another with
/// another, and the first again with the first.
void expectRecalibrates(const Bench& gonio, const Json& measured) {
    const std::string name = measured["name"], own = measured["calibration"];
    EXPECT_TRUE(gonio({"recalibrate", name})["identical"]);
    gonio({"sim", "place", "white"});
    gonio({"calibrate", "white"});
    const Json other = gonio({"recalibrate", name});
    EXPECT_FALSE(other["identical"]);
    EXPECT_EQ(other["before"], own);
    EXPECT_NE(other["calibration"], own);
    EXPECT_EQ(other["earlier"], name + ".1");
    const Json back = gonio({"recalibrate", name, "--calibration", own});
    EXPECT_EQ(back["file"], measured["file"]) << "files are named by their content";
    EXPECT_EQ(gonio({"calibrations"})["calibrations"].size(), 4U);
}

/// Measuring costs and achieves what `plan` says; a budget that is too short is refused.
void expectPlansHold(const Bench& gonio) {
    gonio({"sim", "place", kSamples[3]});
    const Json plan = gonio({"plan", "--target-uncertainty", "3%"});
    EXPECT_EQ(plan["schema"], "gonio/plan/1");
    EXPECT_EQ(plan["goal"], "target 3 %");
    const Json target = gonio({"measure", "target", "--target-uncertainty", "3%"});
    EXPECT_EQ(target["effort"], "target 3 %");
    const double seconds = plan["seconds"]["total"], median = plan["predicted"]["random"]["median"];
    EXPECT_NEAR(target["planned"]["seconds"], seconds, 0.05 * seconds);
    EXPECT_NEAR(target["planned"]["random"]["median"], median, 0.1 * median);
    expectAsPlanned(target);
    const Ran tooShort = gonio.program({"plan", "--time-budget", "1s"});
    EXPECT_EQ(tooShort.exitCode, 2) << tooShort.err;
    EXPECT_NE(tooShort.err.find("at least"), std::string::npos) << tooShort.err;
}

TEST(MeasureRun, WithoutSystematicErrorsNoiseExplainsTheRest) {
    const Bench gonio;
    gonio.calibrate("none", 1);
    const Measured all = measureAll(gonio);
    double inside = 0, cells = 0;
    for (const Json& sample : all.scores) {
        expectAccurate(sample);
        const double count = sample["cells"];
        inside += count * sample["within_2u_random"].get<double>();
        cells += count;
    }
    EXPECT_GE(inside / cells, 0.94);
    EXPECT_LE(inside / cells, 0.97);
    expectUsable(gonio, all.runs[1]);
    expectPlansHold(gonio);
    expectRecalibrates(gonio, all.runs[1]);
}

/// A published fit of a MERL material as the sample on the rig, and its parameters out of what was
/// measured.
TEST(MeasureRun, APublishedFitIsMeasuredAndFoundAgain) {
    const auto file = test::dataFile("merl_model_fits/ngan_ward.fit");
    if (!file) GTEST_SKIP();
    const Bench gonio("[20, 320]");
    gonio.calibrate("none", 3);
    gonio({"sim", "place", "model:merl-fit,material=delrin,F=" + file->string()});
    const Json measured = gonio({"measure", "delrin", "--effort", "draft"});
    const Json scores = gonio({"sim", "score", measured["file"]})["samples"];
    EXPECT_LE(scores[0]["median_relative_error"], 0.02) << scores;
    const Json fits = gonio({"fit", "sample:delrin", "--models", "lambert+ward,lambert"});
    EXPECT_EQ(fits["chosen"], "lambert+ward") << fits["verdict"];
    const std::map<std::string, double> published{{"ward.alpha", 0.162},
                                                  {"lambert.albedo_r", 0.293},
                                                  {"lambert.albedo_g", 0.244},
                                                  {"lambert.albedo_b", 0.146},
                                                  {"ward.ks_r", 0.0348},
                                                  {"ward.ks_g", 0.0295},
                                                  {"ward.ks_b", 0.0202}};
    std::size_t found = 0;
    for (const Json& model : fits["models"]) {
        if (model["model"] != "lambert+ward") continue;
        for (const Json& p : model["parameters"]) {
            const std::string band = p["band"].is_null() ? "" : "_" + p["band"].get<std::string>();
            const double value = p["value"],
                         truth = published.at(p["name"].get<std::string>() + band);
            const double u =
                std::hypot(p["u_random"].get<double>(), p["u_systematic"].get<double>());
            EXPECT_NEAR(value, truth, 3 * u) << p;
            EXPECT_LT(u, 0.03 * truth) << p;
            ++found;
        }
    }
    EXPECT_EQ(found, published.size());
}

/// In `check` tests/device/usb_daemon_test.cpp sees it: on USB and in the daemon's own process.
TEST(MeasureRun, SameSeedGivesTheSameBytes) {
    if (std::getenv("GONIO_NIGHTLY") == nullptr) GTEST_SKIP() << "two whole measurements, nightly";
    const auto measured = [] {
        const Bench gonio("[20, 320]");
        gonio.calibrate("random", 7);
        gonio({"sim", "place", kSamples[2]});
        gonio({"measure", "x", "--effort", "draft"});
        const Ran csv = gonio.program({"convert", "sample:x", gonio.program / "x.csv", "-q"});
        EXPECT_EQ(csv.exitCode, 0) << csv.err;
        return test::rowsOfCsv(gonio.program / "x.csv");
    };
    const std::string once = measured();
    EXPECT_GT(once.size(), 1'000'000U);
    EXPECT_TRUE(once == measured());  // megabytes: no one reads their difference
}

/// Over 20 runs whose systematic errors are stratified, each component of the references takes each
/// of its 20 quantiles once. A long study: it runs with GONIO_NIGHTLY only, and writes its table to
/// $GONIO_COVERAGE_TABLE when that is set.
TEST(CoverageRun, TwoStandardUncertaintiesHoldTheTruthOverStratifiedRuns) {
    if (std::getenv("GONIO_NIGHTLY") == nullptr) GTEST_SKIP() << "a nightly study of 20 runs";
    constexpr int kRuns = 20;
    std::string table;
    std::vector<double> sums(kSamples.size() + 1);
    for (int run = 0; run < kRuns; ++run) {
        const Bench gonio;
        gonio.calibrate("stratum:" + std::to_string(run), 100 + run);
        const Json samples = measureAll(gonio).scores;
        double inside = 0, cells = 0;
        std::string row = "| " + std::to_string(run);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            expectAccurate(samples[i]);
            const double share = samples[i]["within_2u"];
            const double count = samples[i]["cells"];
            sums[i] += share / kRuns;
            inside += share * count;
            cells += count;
            row += " | " + std::to_string(100 * share).substr(0, 5);
        }
        sums.back() += inside / cells / kRuns;
        row += " | " + std::to_string(100 * inside / cells).substr(0, 5) + " |\n";
        std::cout << row << std::flush;
        table += row;
    }
    table += "| mean";
    for (const double mean : sums) table += " | " + std::to_string(100 * mean).substr(0, 5);
    table += " |\n";
    if (const char* file = std::getenv("GONIO_COVERAGE_TABLE")) test::writeText(file, table);
    EXPECT_GE(sums.back(), 0.93);
    EXPECT_LE(sums.back(), 0.98);
}

}  // namespace
}  // namespace gonio
