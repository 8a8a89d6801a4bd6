#include "proc/fit/selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>

#include "proc/formats/scattered_csv.h"
#include "proc/models/spec.h"
#include "proc/solve/chi_square.h"
#include "tests/fit/simulated.h"
#include "tests/support/data_file.h"

namespace gonio::proc {
namespace {

const std::vector<std::string> kTen{"lambert",
                                    "oren-nayar",
                                    "lambert+ggx",
                                    "lambert+beckmann",
                                    "ggx",
                                    "lambert+ggx+ggx",
                                    "lambert+ward-averaged",
                                    "disney-diffuse+ggx",
                                    "phong",
                                    "cod-wwii-diffuse"};

std::vector<const Family*> tenFamilies() {
    std::vector<const Family*> all;
    for (const std::string& name : kTen) all.push_back(*familyNamed(name));
    return all;
}

/// Parameters as materials have them.
class Draw {
public:
    explicit Draw(std::uint64_t seed) : random_(seed) {}

    std::string spec(const std::string& family) {
        const std::string diffuse = ",albedo=" + bands(0.05, 0.6);
        const std::string gloss = ",f0=" + bands(0.03, 0.08);
        if (family == "lambert") return "lambert" + diffuse;
        if (family == "oren-nayar") return "oren-nayar,sigma=" + number(0.3, 1) + diffuse;
        if (family == "lambert+ggx") return "lambert" + diffuse + "+ggx" + gloss + alpha();
        if (family == "lambert+beckmann")
            return "lambert" + diffuse + "+beckmann" + gloss + alpha();
        if (family == "ggx") return "ggx,f0=" + bands(0.3, 0.95) + alpha();
        if (family == "lambert+ggx+ggx") {
            return "lambert" + diffuse + "+ggx" + gloss + ",alpha=" + number(0.04, 0.12) + "+ggx" +
                   gloss + ",alpha=" + number(0.25, 0.7);
        }
        if (family == "lambert+ward-averaged") {
            return "lambert" + diffuse + "+ward,azimuth=averaged,alpha_x=" + number(0.05, 0.12) +
                   ",alpha_y=" + number(0.2, 0.5) + ",ks=" + bands(0.03, 0.2);
        }
        if (family == "disney-diffuse+ggx") {
            return "disney-diffuse,roughness=" + number(0.1, 1) + diffuse + "+ggx" + gloss +
                   alpha();
        }
        if (family == "phong") {
            return "phong,kd=" + bands(0.05, 0.6) + ",ks=" + bands(0.1, 2) +
                   ",n=" + std::to_string(std::exp(between(std::log(5.0), std::log(300.0))));
        }
        return "cod-wwii-diffuse" + diffuse + ",alpha=" + number(0.05, 0.9);
    }

private:
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    std::string number(double low, double high) { return std::to_string(between(low, high)); }
    std::string alpha() {
        return ",alpha=" + std::to_string(std::exp(between(std::log(0.05), std::log(0.6))));
    }
    std::string bands(double low, double high) {
        const std::string r = number(low, high);
        const std::string g = number(low, high);
        return r + "/" + g + "/" + number(low, high);
    }

    std::mt19937_64 random_;
};

SelectionOptions quick() {
    SelectionOptions options;
    options.fit.heldOutRows = 0;
    return options;
}

/// A rival that holds the truth as a special case is at distance 0 and has more parameters; it is
/// no rival.
bool toldApart(const Selection& noiseless, const std::string& truth, std::size_t parameters) {
    for (const RankedFit& one : noiseless.ranked) {
        if (one.fit.family->name() == truth || !one.fit.usable()) continue;
        const bool holdsTruth = one.fit.chiSquare < 1 && one.fit.parameterCount() > parameters;
        if (!holdsTruth && one.fit.chiSquare <= 25) return false;
    }
    return true;
}

/// A simpler rival that the noise cannot tell from the true family's fit: the difference of their
/// chi-squares is one that the additional parameters explain once in 1000 times or more.
bool notRejected(const Selection& selection, const ModelFit& rival, const std::string& truth) {
    for (const RankedFit& one : selection.ranked) {
        if (one.fit.family->name() != truth) continue;
        const double fewer = static_cast<double>(one.fit.parameterCount()) -
                             static_cast<double>(rival.parameterCount());
        if (fewer <= 0) return false;
        return chiSquareTail(rival.chiSquare - one.fit.chiSquare, fewer) >= 1e-3;
    }
    return false;
}

struct Tally {
    int right = 0;
    int exact = 0;  ///< the true family itself
    int all = 0;
};

Tally pickTruth(const std::string& truth, int draws) {
    Tally tally;
    Draw draw(std::accumulate(truth.begin(), truth.end(), 17U));
    const std::size_t parameters = (*familyNamed(truth))->parameterCount(3);
    for (int tries = 0; tally.all < draws && tries < 20 * draws; ++tries) {
        const std::string spec = draw.spec(truth);
        const auto surface = makeModel(spec);
        EXPECT_TRUE(surface) << spec;
        const BrdfData exact = test::simulated(**surface, 400);
        if (!toldApart(selectModel(tenFamilies(), exact, quick()), truth, parameters)) continue;
        ++tally.all;
        const BrdfData data = test::noisy(exact, static_cast<std::uint64_t>(tries) + 1);
        const Selection selection = selectModel(tenFamilies(), data, quick());
        if (!selection.chosen) {
            std::cout << truth << ": " << selection.verdict << " (" << spec << ")\n";
            continue;
        }
        const ModelFit& chosen = selection.ranked[*selection.chosen].fit;
        const bool right = chosen.family->name() == truth || notRejected(selection, chosen, truth);
        tally.right += right ? 1 : 0;
        tally.exact += chosen.family->name() == truth ? 1 : 0;
        if (!right) std::cout << truth << ": " << selection.verdict << " (" << spec << ")\n";
    }
    EXPECT_EQ(tally.all, draws) << truth << ": too few draws are told apart";
    return tally;
}

TEST(Selection, PicksTheTrueFamilyOfNoisySamples) {
    const int draws = std::getenv("GONIO_NIGHTLY") != nullptr ? 20 : 1;
    int right = 0;
    int all = 0;
    for (const std::string& truth : kTen) {
        const Tally tally = pickTruth(truth, draws);
        std::cout << truth << ": " << tally.right << " of " << tally.all << ", itself "
                  << tally.exact << "\n";
        right += tally.right;
        all += tally.all;
    }
    EXPECT_GE(right, 0.95 * all);
}

TEST(Selection, RanksByErrorAndMarksTheParetoFront) {
    const auto surface = makeModel("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.2,f0=0.05");
    const BrdfData data = test::noisy(test::simulated(**surface, 400), 4);
    SelectionOptions options;
    options.nanoseconds = [](const std::string& spec) -> std::optional<double> {
        return static_cast<double>(spec.size());
    };
    const auto list = familiesNamed("lambert,oren-nayar,ggx,lambert+ggx,lambert+ggx+ggx");
    const Selection selection = selectModel(*list, data, options);
    ASSERT_EQ(selection.ranked.size(), 5U);
    for (std::size_t i = 1; i < 5; ++i) {
        EXPECT_GE(selection.ranked[i].error(), selection.ranked[i - 1].error());
    }
    for (const RankedFit& one : selection.ranked) {
        const bool beaten =
            std::any_of(selection.ranked.begin(), selection.ranked.end(), [&](const RankedFit& o) {
                return o.error() < one.error() && o.nanoseconds < one.nanoseconds &&
                       o.fit.parameterCount() < one.fit.parameterCount();
            });
        EXPECT_FALSE(beaten && one.pareto);
        // The fewest parameters.
        EXPECT_TRUE(one.fit.family->name() != "lambert" || one.pareto);
    }
    ASSERT_TRUE(selection.chosen);
    EXPECT_EQ(selection.ranked[*selection.chosen].fit.family->name(), "lambert+ggx");
}

/// Uncertainties half of the scatter: chi-square 4, and no systematic uncertainty to hide it.
TEST(Selection, AMisfitWithoutSystematicUncertaintyFitsNone) {
    const auto surface = makeModel("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.2,f0=0.05");
    BrdfData data = test::noisy(test::simulated(**surface, 400), 4);
    for (FitRow& row : data.rows) {
        for (double& u : row.uRandom) u /= 2;
    }
    const Selection selection = selectModel(tenFamilies(), data, quick());
    EXPECT_FALSE(selection.chosen) << selection.verdict;
    EXPECT_GT(selection.misfit, 1);
}

/// A white of 0.5 % and a seat of 0.25 degree, as budgets have them.
void budgetTilt(BrdfData& data) {
    for (FitRow& row : data.rows) {
        const Vec<double>& wo = data.nodesOf(row).front().pair.out;
        const double tilt = 0.25 * kPi / 180 * std::hypot(wo.x, wo.y) / wo.z;
        for (std::size_t b = 0; b < 3; ++b) row.uSystematic[b] = std::hypot(0.005, tilt) * row.f[b];
    }
}

/// A tilt of 0.1 degree, in the budget as 0.25 degree, makes a matt sample seem glossy to noise of
/// 0.1 %. Without that uncertainty lambert is rejected; with it nothing else can be told.
TEST(Selection, WhatSystematicUncertaintyHidesRejectsNoFamily) {
    const auto surface = makeModel("lambert,albedo=0.3/0.2/0.1");
    const auto truth = test::simulated(**surface, 400, {.relative = 1e-3, .floor = 1e-6});
    BrdfData data = test::noisy(truth, 6);
    for (FitRow& row : data.rows) {
        const Vec<double>& wo = data.nodesOf(row).front().pair.out;
        for (double& f : row.f) f *= 1 + 0.1 * kPi / 180 * wo.x / wo.z;
    }
    const auto list = familiesNamed("lambert,oren-nayar,phong,lambert+ggx");
    const Selection sharp = selectModel(*list, data, quick());
    EXPECT_TRUE(!sharp.chosen || sharp.ranked[*sharp.chosen].fit.family->name() != "lambert");
    budgetTilt(data);
    const Selection honest = selectModel(*list, data, quick());
    ASSERT_TRUE(honest.chosen) << honest.verdict;
    EXPECT_EQ(honest.ranked[*honest.chosen].fit.family->name(), "lambert") << honest.verdict;
    // It hides no lobe.
    const auto glossy = makeModel("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.3,f0=0.04");
    BrdfData shiny = test::noisy(test::simulated(**glossy, 400), 7);
    budgetTilt(shiny);
    const Selection told = selectModel(*list, shiny, quick());
    ASSERT_TRUE(told.chosen) << told.verdict;
    EXPECT_EQ(told.ranked[*told.chosen].fit.family->name(), "lambert+ggx") << told.verdict;
}

TEST(Selection, NothingFittedIsSaidSo) {
    const BrdfData nothing;
    const Selection selection = selectModel(tenFamilies(), nothing);
    EXPECT_FALSE(selection.chosen);
    EXPECT_EQ(selection.verdict, "no family could be fitted");
}

/// The file's own columns (SOURCES.md): incidence, signed theta_out in two projections, f cos.
Result<FileRead<BrdfRows>> tape(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::ostringstream csv;
    csv.precision(17);
    csv << "theta_i,phi_i,theta_o,phi_o,f\n";
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        double thetaI = 0;
        double along = 0;
        double across = 0;
        double value = 0;
        if (line.starts_with("#") || !(fields >> thetaI >> along >> across >> value)) continue;
        const double thetaO = std::hypot(along, across);
        if (thetaO > (75_deg).value()) continue;
        csv << thetaI * 180 / kPi << ",0," << thetaO * 180 / kPi << ","
            << std::atan2(across, along) * 180 / kPi << "," << value / std::cos(thetaO) << "\n";
    }
    return parseScatteredCsv(csv.str(), "tape");
}

TEST(Selection, NoFamilyFitsARetroreflectiveTape) {
    const auto file = test::dataFile("retroreflective/retro-3M-jaune.dat");
    if (!file) GTEST_SKIP();
    const auto points = tape(*file);
    ASSERT_TRUE(points) << points.error().message;
    const auto data = fitDataOf(points->content);
    ASSERT_TRUE(data) << data.error().message;
    ASSERT_GT(data->rows.size(), 5000U);
    const Selection selection = selectModel(*familiesNamed("all"), *data);
    EXPECT_FALSE(selection.chosen);
    EXPECT_TRUE(selection.verdict.starts_with("none fits")) << selection.verdict;
    std::cout << selection.verdict << "\n";
    ASSERT_FALSE(selection.worst.empty());
    // What no family has: a lobe back to the source.
    bool back = false;
    for (const Misfit& one : selection.worst) {
        back |= one.region == "toward the light" && one.meanRatio > 1.5;
    }
    EXPECT_TRUE(back);
}

}  // namespace
}  // namespace gonio::proc
