#include "proc/fit/model_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdlib>
#include <map>

#include "proc/fit/fit_sums.h"
#include "proc/models/spec.h"
#include "proc/solve/least_squares.h"
#include "tests/fit/simulated.h"

namespace gonio::proc {
namespace {

BrdfData dataOf(const std::string& spec, std::size_t perIncidence = 1500) {
    const auto surface = makeModel(spec);
    EXPECT_TRUE(surface) << spec;
    return test::simulated(**surface, perIncidence);
}

const Family& family(const std::string& name) {
    const auto found = familyNamed(name);
    EXPECT_TRUE(found) << name;
    return **found;
}

double valueOf(const ModelFit& fit, const std::string& name, std::optional<Band> band = {}) {
    for (const FittedParameter& p : fit.parameters) {
        if (p.name == name && (!band || p.band == band)) return p.value;
    }
    ADD_FAILURE() << "no parameter " << name;
    return 0;
}

ModelFitOptions withoutHeldOut() {
    ModelFitOptions options;
    options.heldOutRows = 0;
    return options;
}

TEST(ModelFit, RecoversParametersOfNoiselessDataToOnePerMille) {
    for (const double alpha : {0.02, 0.035, 0.06, 0.1, 0.18, 0.3, 0.5, 0.8, 1.0}) {
        const std::string width = ",alpha=" + std::to_string(alpha);
        const BrdfData plastic = dataOf("lambert,albedo=0.3/0.2/0.1+ggx,f0=0.04" + width);
        const ModelFit a = fitModel(family("lambert+ggx"), plastic, withoutHeldOut());
        ASSERT_TRUE(a.usable()) << alpha << ": " << a.message;
        EXPECT_NEAR(valueOf(a, "ggx.alpha"), alpha, 1e-3 * alpha);
        EXPECT_NEAR(valueOf(a, "lambert.albedo", Band::R), 0.3, 1e-3 * 0.3);
        EXPECT_NEAR(valueOf(a, "lambert.albedo", Band::B), 0.1, 1e-3 * 0.1);
        EXPECT_NEAR(valueOf(a, "ggx.f0", Band::G), 0.04, 1e-3 * 0.04);

        const BrdfData metal = dataOf("ggx,f0=0.9/0.6/0.3" + width);
        const ModelFit b = fitModel(family("ggx"), metal, withoutHeldOut());
        ASSERT_TRUE(b.usable()) << alpha << ": " << b.message;
        EXPECT_NEAR(valueOf(b, "alpha"), alpha, 1e-3 * alpha);
        EXPECT_NEAR(valueOf(b, "f0", Band::R), 0.9, 1e-3 * 0.9);

        const BrdfData beckmann = dataOf("lambert,albedo=0.3/0.2/0.1+beckmann,f0=0.04" + width);
        const ModelFit c = fitModel(family("lambert+beckmann"), beckmann, withoutHeldOut());
        EXPECT_NEAR(valueOf(c, "beckmann.alpha"), alpha, 1e-3 * alpha) << c.message;
    }
}

TEST(ModelFit, RecoversTwoLobes) {
    const BrdfData data =
        dataOf("lambert,albedo=0.1+ggx,alpha=0.05,f0=0.03/0.04/0.05+ggx,alpha=0.4,f0=0.1");
    const ModelFit fit = fitModel(family("lambert+ggx+ggx"), data, withoutHeldOut());
    ASSERT_TRUE(fit.usable()) << fit.message;
    EXPECT_NEAR(valueOf(fit, "ggx1.alpha"), 0.05, 1e-3 * 0.05);
    EXPECT_NEAR(valueOf(fit, "ggx2.alpha"), 0.4, 1e-3 * 0.4);
    EXPECT_NEAR(valueOf(fit, "ggx2.f0", Band::G), 0.1, 1e-4);
}

/// Of an interval that holds a value with probability 0.95: the share of N repeats lies within 4
/// standard deviations sqrt(0.95 0.05 / N) of 0.95 but once in 16,000 times; with 1,000 repeats,
/// where the demand is 93.5..97 %, the demand itself.
TEST(ModelFit, CoversTheTruthAsOftenAsItsUncertaintySays) {
    const int repeats = std::getenv("GONIO_NIGHTLY") != nullptr ? 1000 : 200;
    const BrdfData truth = dataOf("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.15,f0=0.05", 250);
    const Family& plastic = family("lambert+ggx");
    const double margin = 4 * std::sqrt(0.95 * 0.05 / repeats);
    const double low = repeats >= 1000 ? 0.935 : 0.95 - margin;
    const double high = repeats >= 1000 ? 0.97 : 0.95 + margin;
    const std::vector<double> expected{0.15, 0.3, 0.2, 0.1, 0.05, 0.05, 0.05};
    std::vector<int> held(expected.size(), 0);
    double chiSquare = 0;
    for (int i = 0; i < repeats; ++i) {
        const BrdfData data = test::noisy(truth, 1000 + static_cast<std::uint64_t>(i));
        const ModelFit fit = fitModel(plastic, data, withoutHeldOut());
        ASSERT_EQ(fit.status, FitStatus::Converged) << fit.message;
        chiSquare += fit.chiSquarePerDof();
        for (std::size_t k = 0; k < expected.size(); ++k) {
            const FittedParameter& p = fit.parameters[k];
            held[k] += std::abs(p.value - expected[k]) <= 1.96 * p.uRandom ? 1 : 0;
        }
    }
    for (std::size_t k = 0; k < expected.size(); ++k) {
        const double share = static_cast<double>(held[k]) / repeats;
        EXPECT_GE(share, low) << k;
        EXPECT_LE(share, high) << k;
        std::cout << "coverage of parameter " << k << ": " << share << "\n";
    }
    // 3,000 values each: a mean over the repeats of 1 to a fraction of a per cent.
    EXPECT_NEAR(chiSquare / repeats, 1, 0.01);
}

/// Errors that values share, far larger than the noise of a mean over cells: each LED and band off
/// by its own draw, and each patch of directions under it by another.
class SharedErrors : public ::testing::Test {
protected:
    explicit SharedErrors() {
        constexpr BudgetShare kShare{.patch = kPatch, .state = kState};
        truth_.shared.assign(truth_.incidences.size(), {kShare, kShare, kShare});
    }

    [[nodiscard]] BrdfData drawn(std::uint64_t seed) const {
        BrdfData data = test::noisy(truth_, seed);
        std::mt19937_64 random(seed + 1);
        std::normal_distribution<double> normal;
        std::map<std::array<std::size_t, 3>, double> offsets;
        const auto offset = [&](std::size_t group, std::size_t band, std::size_t patch) -> double& {
            const double size = patch == kPatches ? kState : kPatch;
            const auto [at, fresh] = offsets.try_emplace({group, band, patch}, 0);
            if (fresh) at->second = size * normal(random);
            return at->second;
        };
        for (std::size_t r = 0; r < data.rows.size(); ++r) {
            FitRow& row = data.rows[r];
            for (std::size_t b = 0; b < 3; ++b) {
                row.f[b] += truth_.rows[r].f[b] *
                            (offset(row.group, b, kPatches) + offset(row.group, b, row.patch));
            }
        }
        return data;
    }

    static constexpr double kState = 0.005;
    static constexpr double kPatch = 0.01;
    BrdfData truth_ = dataOf("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.15,f0=0.05", 400);
};

struct CoverageOfFour {
    std::array<int, 4> held{};
    std::array<double, 4> meanSquare{};  ///< of error over u
    double chiSquarePerDof = 0;

    /// Neither too narrow nor too wide: 4 standard deviations of a binomial, and of a mean of 100
    /// squares of standard normal numbers.
    void expectTrue() const {
        for (const int count : held) EXPECT_GE(count, kFewest);
        for (const double square : meanSquare) {
            EXPECT_GE(square, 1 - 4 * std::sqrt(2.0 / kRepeats));
            EXPECT_LE(square, 1 + 4 * std::sqrt(2.0 / kRepeats));
        }
    }
    static constexpr int kRepeats = 100;
    static constexpr int kFewest = 95 - 9;
};
template <class Draw>
CoverageOfFour coverage(const ModelFitOptions& options, Draw&& draw) {
    constexpr int repeats = CoverageOfFour::kRepeats;
    const std::array<double, 4> expected{0.15, 0.3, 0.2, 0.1};
    CoverageOfFour all;
    for (int i = 0; i < repeats; ++i) {
        const BrdfData data = draw(9000 + 2 * static_cast<std::uint64_t>(i));
        const ModelFit fit = fitModel(family("lambert+ggx"), data, options);
        EXPECT_EQ(fit.status, FitStatus::Converged) << fit.message;
        all.chiSquarePerDof += fit.chiSquarePerDof() / repeats;
        for (std::size_t k = 0; k < expected.size(); ++k) {
            const FittedParameter& p = fit.parameters[k];
            const double off = (p.value - expected[k]) / p.uRandom;
            all.held[k] += std::abs(off) <= 1.96 ? 1 : 0;
            all.meanSquare[k] += off * off / repeats;
        }
    }
    return all;
}

TEST_F(SharedErrors, AreInTheUncertaintiesAndNotInChiSquare) {
    const auto draw = [this](std::uint64_t seed) { return drawn(seed); };
    const CoverageOfFour known = coverage(withoutHeldOut(), draw);
    known.expectTrue();
    EXPECT_NEAR(known.chiSquarePerDof, 1, 0.015);
    // Taken for noise of each cell alone, as much in all, the intervals are too narrow.
    const CoverageOfFour alone = coverage(withoutHeldOut(), [this](std::uint64_t seed) {
        BrdfData data = drawn(seed);
        for (FitRow& row : data.rows) {
            for (std::size_t b = 0; b < 3; ++b) row.uRandom[b] = data.uOf(row, b);
        }
        data.shared.clear();
        return data;
    });
    for (const int count : alone.held) EXPECT_LT(count, CoverageOfFour::kFewest);
}

TEST_F(SharedErrors, AreInTheUncertaintiesOfOtherWeightsAndLosses) {
    const auto draw = [this](std::uint64_t seed) { return drawn(seed); };
    ModelFitOptions cosine = withoutHeldOut();
    cosine.weights = {.uncertainty = true, .cosine = true};
    coverage(cosine, draw).expectTrue();
    ModelFitOptions robust = withoutHeldOut();
    robust.loss = RobustLoss::Huber;
    coverage(robust, draw).expectTrue();
}

/// Values that are off by far more than they say are all beyond the loss' scale.
TEST(ModelFit, ARobustLossWithNothingWithinItsScaleGivesNoUncertainty) {
    BrdfData data = test::noisy(dataOf("lambert,albedo=0.3", 250), 3);
    for (FitRow& row : data.rows) {
        for (double& u : row.uRandom) u = 1e-9;
    }
    ModelFitOptions options = withoutHeldOut();
    options.loss = RobustLoss::Huber;
    const ModelFit fit = fitModel(family("lambert"), data, options);
    EXPECT_NEAR(fit.parameters[0].value, 0.3, 0.003);
    EXPECT_TRUE(std::isnan(fit.parameters[0].uRandom));
    EXPECT_FALSE(fit.warnings.empty());
}

/// r^T C^-1 r by the covariance written out and factorised.
TEST_F(SharedErrors, ChiSquareIsThatOfTheFullCovariance) {
    const BrdfData data = drawn(5);
    const Family& plastic = family("lambert+ggx");
    FitSums sums(plastic, data, withoutHeldOut());
    const FamilyPoint point{.shared = {0.15}, .perBand = {{{0.3, 0.2, 0.1}}, LedBands::all(0.05)}};
    sums.shareErrors(point);
    std::vector<std::uint32_t> rows;
    double expected = 0;
    for (std::uint16_t group = 0; group < data.incidences.size(); ++group) {
        std::vector<const FitRow*> members;
        for (std::size_t i = 0; i < data.rows.size(); ++i) {
            if (data.rows[i].group != group) continue;
            members.push_back(&data.rows[i]);
            rows.push_back(static_cast<std::uint32_t>(i));
        }
        const auto n = static_cast<Eigen::Index>(members.size());
        for (std::size_t b = 0; b < 3; ++b) {
            Eigen::VectorXd r(n);
            Eigen::VectorXd m(n);
            for (Eigen::Index i = 0; i < n; ++i) {
                const FitRow& row = *members[static_cast<std::size_t>(i)];
                m(i) = plastic.f(point, std::span(&data.nodes[row.firstNode], 1)).value[b];
                r(i) = row.f[b] - m(i);
            }
            Eigen::MatrixXd c = kState * kState * m * m.transpose();
            for (Eigen::Index i = 0; i < n; ++i) {
                const FitRow& a = *members[static_cast<std::size_t>(i)];
                c(i, i) += a.uRandom[b] * a.uRandom[b];
                for (Eigen::Index k = 0; k < n; ++k) {
                    const bool alike = a.patch == members[static_cast<std::size_t>(k)]->patch;
                    if (alike) c(i, k) += kPatch * kPatch * m(i) * m(k);
                }
            }
            expected += r.dot(c.llt().solve(r));
        }
    }
    EXPECT_NEAR(sums.chiSquare(point, rows), expected, 1e-8 * expected);
    const std::vector<double> q{std::log(0.15), 0.3, 0.2, 0.1, 0.05, 0.05, 0.05};
    EXPECT_NEAR(sums.sums(q, rows, Wanted::Cost)->cost, expected, 1e-8 * expected);
    const auto all = sums.sums(q, rows, Wanted::Derivatives);
    EXPECT_NEAR(all->cost, expected, 1e-8 * expected);
    // The gradient of half the cost, by differences.
    for (std::size_t k = 0; k < q.size(); ++k) {
        std::vector<double> up = q;
        std::vector<double> down = q;
        up[k] += 1e-6;
        down[k] -= 1e-6;
        const double slope =
            (sums.sums(up, rows, Wanted::Cost)->cost - sums.sums(down, rows, Wanted::Cost)->cost) /
            4e-6;
        const double found = all->gradient(static_cast<Eigen::Index>(k));
        EXPECT_NEAR(found, slope, 1e-4 * std::abs(slope) + 1e-2) << k;
    }
}

TEST(Patches, AreAboutFiveDegreesWide) {
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        members[patchOf(cell)].push_back(cell);
    }
    EXPECT_LT(members.rbegin()->first, kPatches);
    double largest = 0;
    double least = 1e9;
    for (const auto& [patch, cells] : members) {
        double solidAngle = 0;
        for (const std::size_t cell : cells) {
            solidAngle += CellGrid::solidAngle(cell);
            for (const std::size_t other : cells) {
                EXPECT_LT(angleBetween({CellGrid::centre(cell), CellGrid::centre(other)}), 9_deg);
            }
        }
        largest = std::max(largest, solidAngle);
        least = std::min(least, solidAngle);
    }
    const double square = std::pow(Radians(5_deg).value(), 2);
    EXPECT_LT(largest, 1.5 * square);
    EXPECT_GT(least, 0.6 * square);
}

TEST(ModelFit, WithOtherWeightsOrLossesItsCovarianceStaysTrue) {
    const BrdfData truth = dataOf("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.15,f0=0.05", 250);
    const auto draw = [&](std::uint64_t seed) { return test::noisy(truth, seed); };
    ModelFitOptions cosine = withoutHeldOut();
    cosine.weights = {.uncertainty = false, .cosine = true};
    coverage(cosine, draw).expectTrue();
    std::vector<RobustLoss> losses{RobustLoss::Cauchy};
    if (std::getenv("GONIO_NIGHTLY") != nullptr) losses.push_back(RobustLoss::Huber);
    for (const RobustLoss loss : losses) {
        ModelFitOptions robust = withoutHeldOut();
        robust.loss = loss;
        robust.lossScale = 1;
        coverage(robust, draw).expectTrue();
    }
}

/// Of data that are three times as uncertain as assumed, and say so by their chi-square.
TEST(ModelFit, AnAssumedUncertaintyIsScaledByTheMisfit) {
    const BrdfData truth = dataOf("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.15,f0=0.05", 250);
    const auto draw = [&](std::uint64_t seed) {
        BrdfData data = test::noisy(truth, seed);
        data.uKnown = false;
        for (FitRow& row : data.rows) {
            for (double& u : row.uRandom) u /= 3;
        }
        return data;
    };
    const CoverageOfFour all = coverage(withoutHeldOut(), draw);
    all.expectTrue();
    EXPECT_NEAR(all.chiSquarePerDof, 9, 0.2);
}

/// All values of a band shift together: the albedo follows, by as much, with any weights.
TEST(ModelFit, SystematicUncertaintyIsTheShiftThatItCauses) {
    const BrdfData truth = dataOf("lambert,albedo=0.3/0.2/0.1", 250);
    BrdfData data = test::noisy(truth, 8);
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        for (std::size_t b = 0; b < 3; ++b) {
            data.rows[i].uSystematic[b] = 0.01 * truth.rows[i].f[b];
        }
    }
    for (const RobustLoss loss : {RobustLoss::None, RobustLoss::Huber, RobustLoss::Cauchy}) {
        for (const bool cosine : {false, true}) {
            ModelFitOptions options = withoutHeldOut();
            options.loss = loss;
            options.lossScale = 1;
            options.weights.cosine = cosine;
            const ModelFit fit = fitModel(family("lambert"), data, options);
            ASSERT_TRUE(fit.usable());
            EXPECT_NEAR(fit.parameters[0].uSystematic, 0.003, 1e-5);
            EXPECT_NEAR(fit.parameters[2].uSystematic, 0.001, 1e-5);
        }
    }
}

TEST(ModelFit, ABandThatWasNotMeasuredHasNoParameters) {
    BrdfData data = test::noisy(dataOf("lambert,albedo=0.3/0.2/0.1", 250), 2);
    for (FitRow& row : data.rows) row.f[1] = std::nan("");
    const ModelFit fit = fitModel(family("lambert"), data);
    ASSERT_EQ(fit.status, FitStatus::Converged) << fit.message;
    EXPECT_EQ(fit.parameterCount(), 2U);
    EXPECT_TRUE(std::isnan(fit.parameters[1].value));
    EXPECT_FALSE(fit.parameters[1].atLower);
    EXPECT_NEAR(fit.parameters[0].value, 0.3, 5 * fit.parameters[0].uRandom);
    EXPECT_GT(fit.parameters[2].uRandom, 0);
    EXPECT_NE(fit.spec.find("/0/"), std::string::npos) << fit.spec;
    ASSERT_FALSE(fit.warnings.empty());
    EXPECT_NE(fit.warnings[0].find("albedo_g"), std::string::npos) << fit.warnings[0];
}

TEST(ModelFit, FindsAnAnisotropicLobeEitherWayAround) {
    for (const char* widths : {"alpha_x=0.4,alpha_y=0.05", "alpha_x=0.05,alpha_y=0.4"}) {
        const BrdfData data = dataOf(std::string("lambert,albedo=0.1+ward,ks=0.2,") + widths, 400);
        const ModelFit fit = fitModel(family("lambert+ward-anisotropic"), data, withoutHeldOut());
        ASSERT_TRUE(fit.usable()) << fit.message;
        EXPECT_LT(fit.chiSquare, 1e-6) << fit.spec;
    }
}

/// The mean over the repeats of what an incidence is mispredicted by is what noise makes of it:
/// rows of a refit that were picked by their noise would bias the albedo.
TEST(ModelFit, HeldOutErrorsOfNoiseAreThoseOfNoise) {
    const BrdfData truth = dataOf("lambert,albedo=0.3/0.2/0.1", 1500);
    ModelFitOptions options;
    options.heldOutRows = 400;
    double off = 0;
    constexpr int kDraws = 20;
    for (int i = 0; i < kDraws; ++i) {
        const BrdfData data = test::noisy(truth, 100 + static_cast<std::uint64_t>(i));
        const ModelFit fit = fitModel(family("lambert"), data, options);
        ASSERT_EQ(fit.heldOut.size(), 4U);
        for (const HeldOut& one : fit.heldOut) off += (one.chiSquare - 1) / (4.0 * kDraws);
    }
    // 4500 values an incidence: the mean of 80 is known to 0.0024, and 1 / 400 is the refit's own.
    EXPECT_NEAR(off, 1.0 / 400, 0.01);
}

TEST(ModelFit, RobustLossBearsOutliers) {
    BrdfData data =
        test::noisy(dataOf("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.15,f0=0.05", 400), 5);
    for (std::size_t i = 0; i < data.rows.size(); i += 20) data.rows[i].f[0] *= 2;
    ModelFitOptions options = withoutHeldOut();
    const ModelFit plain = fitModel(family("lambert+ggx"), data, options);
    for (const RobustLoss loss : {RobustLoss::Huber, RobustLoss::Cauchy}) {
        options.loss = loss;
        options.lossScale = 2;
        const ModelFit robust = fitModel(family("lambert+ggx"), data, options);
        ASSERT_TRUE(robust.usable());
        EXPECT_NEAR(valueOf(robust, "lambert.albedo", Band::R), 0.3, 0.006);
        EXPECT_LT(std::abs(valueOf(robust, "lambert.albedo", Band::R) - 0.3),
                  std::abs(valueOf(plain, "lambert.albedo", Band::R) - 0.3));
    }
}

TEST(ModelFit, NamesTheBoundThatHoldsAParameter) {
    const BrdfData data = dataOf("lambert,albedo=0.3", 400);
    const ModelFit fit = fitModel(family("phong"), data, withoutHeldOut());
    ASSERT_TRUE(fit.usable()) << fit.message;
    EXPECT_NEAR(valueOf(fit, "kd", Band::G), 0.3, 1e-4);
    EXPECT_LT(valueOf(fit, "ks", Band::G), 1e-4);
    // No lobe: its strength is at its bound, or its exponent is free.
    const bool free = fit.status == FitStatus::Singular;
    bool named = false;
    for (const std::string& warning : fit.warnings) {
        named |= warning.find("ks_") == 0 && warning.find("held by its lower bound 0") > 0;
        named |= free && warning.find("do not tell all parameters apart") != std::string::npos;
    }
    EXPECT_TRUE(named) << fit.message;
}

TEST(ModelFit, HoldsOutEachIncidence) {
    const BrdfData exact = dataOf("lambert,albedo=0.3+ggx,alpha=0.2,f0=0.05", 500);
    const ModelFit fit = fitModel(family("lambert+ggx"), exact);
    ASSERT_EQ(fit.heldOut.size(), 4U);
    for (const HeldOut& one : fit.heldOut) EXPECT_LT(one.rms, 1e-4);
    const ModelFit wrong = fitModel(family("oren-nayar"), exact);
    ASSERT_EQ(wrong.heldOut.size(), 4U);
    EXPECT_GT(*wrong.heldOutRms(), 0.05);
    EXPECT_GT(*wrong.heldOutEnergyRms(), 0.05);
}

TEST(ModelFit, ItsSpecIsTheModel) {
    const BrdfData data = dataOf("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.2,f0=0.05", 300);
    for (const auto& one : families()) {
        const ModelFit fit = fitModel(*one, data, withoutHeldOut());
        ASSERT_TRUE(fit.usable()) << one->name() << ": " << fit.message;
        const auto model = makeModel(fit.spec);
        ASSERT_TRUE(model) << fit.spec << ": " << model.error().message;
        for (std::size_t i = 0; i < data.rows.size(); i += 37) {
            const WeightedNode& node = data.nodes[data.rows[i].firstNode];
            const auto direction = [](const Vec<double>& v) {
                return *Direction::fromVector({v.x, v.y, v.z});
            };
            const LedBands expected =
                (*model)->answer({direction(node.pair.in), direction(node.pair.out)}).f;
            const LedBands f = one->f(fit.point, std::span(&node, 1));
            for (const Band b : kBands) {
                EXPECT_NEAR(f[b], expected[b], 1e-9 * std::abs(expected[b]) + 1e-14) << fit.spec;
            }
        }
    }
}

TEST(ModelFit, RefusesFewerValuesThanParameters) {
    BrdfData data = dataOf("lambert,albedo=0.3", 300);
    data.rows.resize(2);
    const ModelFit fit = fitModel(family("lambert+ggx"), data);
    EXPECT_EQ(fit.status, FitStatus::TooFewData);
    EXPECT_TRUE(std::isnan(fit.parameters[0].value));
    EXPECT_TRUE(std::isnan(fit.chiSquare));
    data.rows.clear();
    EXPECT_EQ(fitModel(family("lambert"), data).status, FitStatus::TooFewData);
}

TEST(ModelFit, GivesTheSameBitsEachTime) {
    const BrdfData data = test::noisy(dataOf("ggx,alpha=0.3,f0=0.5", 300), 3);
    const ModelFit a = fitModel(family("lambert+ggx"), data);
    const ModelFit b = fitModel(family("lambert+ggx"), data);
    EXPECT_EQ(a.spec, b.spec);
    EXPECT_EQ(a.chiSquare, b.chiSquare);
}

}  // namespace
}  // namespace gonio::proc
