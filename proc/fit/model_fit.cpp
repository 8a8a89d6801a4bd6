#include "proc/fit/model_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "proc/core/number_text.h"
#include "proc/fit/fit_sums.h"
#include "proc/fit/thinned_rows.h"

namespace gonio::proc {
namespace {

using Index = Eigen::Index;
using Rows = std::vector<std::uint32_t>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kRefined = 3;  ///< starts that are refined

struct Start {
    double cost;
    std::vector<double> q;
};

struct Search {
    int iterations;
    double tolerance = 1e-12;
};

/// What tells starts apart.
constexpr Search kRefining{.iterations = 30, .tolerance = 1e-6};

/// Every point of the grid of shared parameters, with the per-band ones that suit it.
std::vector<Start> gridOfStarts(const Family& family, const FitSums& sums, const Rows& rows) {
    std::vector<double> first(sums.count());
    for (std::size_t i = 0; i < sums.count(); ++i) {
        const FamilyParameter& p = sums.parameter(i);
        first[i] = sums.isHeld(i) ? p.lower : p.starts.front();
    }
    std::vector<std::vector<double>> grid{first};
    for (std::size_t i = 0; i < family.sharedCount(); ++i) {
        const FamilyParameter& p = sums.parameter(i);
        std::vector<std::vector<double>> wider;
        for (const std::vector<double>& at : grid) {
            for (const double value : p.starts) {
                const double q = p.scale == ParameterScale::Log ? std::log(value) : value;
                if (p.likeTheOneBefore && q < at[i - 1]) continue;
                wider.push_back(at);
                wider.back()[i] = q;
            }
        }
        grid = std::move(wider);
    }
    std::vector<Start> starts;
    for (std::vector<double>& q : grid) {
        const double cost = sums.solvePerBand(q, rows);
        if (std::isfinite(cost)) starts.push_back({cost, std::move(q)});
    }
    std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) {
        return a.cost < b.cost;
    });
    return starts;
}

NormalFit solve(const FitSums& sums,
                const Rows& rows,
                const std::vector<double>& start,
                const Search& search) {
    return fitNormal({.sums = [&](std::span<const double> q,
                                  Wanted wanted) { return sums.sums(q, rows, wanted); },
                      .residualCount = sums.residualCount(rows),
                      .start = start,
                      .lower = sums.lower(),
                      .upper = sums.upper(),
                      .maxIterations = search.iterations,
                      .tolerance = search.tolerance});
}

Rows allRows(const BrdfData& data) {
    Rows rows(data.rows.size());
    std::iota(rows.begin(), rows.end(), 0U);
    return rows;
}

std::vector<FittedParameter> namedParameters(const Family& family,
                                             const FitSums& sums,
                                             const BrdfData& data) {
    std::vector<FittedParameter> all;
    for (std::size_t i = 0; i < sums.count(); ++i) {
        const FamilyParameter& p = sums.parameter(i);
        FittedParameter named{.name = family.fullName(p), .unit = std::string(p.unit)};
        named.lower = p.lower;
        named.upper = p.upper;
        if (p.perBand && data.bands == BandCount::Three) {
            named.band = kBands[(i - family.sharedCount()) % 3];
        }
        named.measured = !sums.isHeld(i);
        named.value = named.uRandom = named.uSystematic = kNan;
        all.push_back(std::move(named));
    }
    return all;
}

std::string shownName(const FittedParameter& p) {
    return p.band ? p.name + "_" + std::string(letter(*p.band)) : p.name;
}

/// Of the free parameters, as values: see model_fit.h.
void fillUncertainties(const FitSums& sums,
                       const Rows& rows,
                       const NormalFit& solved,
                       ModelFit& fit) {
    const auto n = static_cast<Index>(sums.count());
    fit.covariance = Eigen::MatrixXd::Constant(n, n, kNan);
    fit.correlation = Eigen::MatrixXd::Constant(n, n, kNan);
    if (solved.status != FitStatus::Converged) return;
    const FitSums::Spread spread = sums.spread(solved.params, rows);
    std::vector<Index> free;
    for (Index i = 0; i < n; ++i) {
        if (!solved.atBound[static_cast<std::size_t>(i)]) free.push_back(i);
    }
    // Of a fit without the shared errors: with them an LED's offset would take up what is common.
    const auto curvature = spread.curvature(free, free).eval().ldlt();
    if (!curvature.isPositive() || !(curvature.rcond() > 1e-14)) {
        fit.warnings.emplace_back(
            "too few values lie within the robust loss' scale: no covariance can be given");
        return;
    }
    Eigen::VectorXd slope(static_cast<Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i) {
        const auto place = static_cast<std::size_t>(free[i]);
        slope(static_cast<Index>(i)) = sums.slope(place, solved.params[place]);
    }
    const Eigen::MatrixXd left = curvature.solve(spread.noise(free, free));
    const Eigen::MatrixXd byNumbers = sums.byCovariance()
                                          ? Eigen::MatrixXd(solved.covariance(free, free))
                                          : Eigen::MatrixXd(curvature.solve(left.transpose()));
    const double scale = sums.assumedScale(fit.chiSquarePerDof());
    const Eigen::MatrixXd covariance = scale * slope.asDiagonal() * byNumbers * slope.asDiagonal();
    const Eigen::MatrixXd shift =
        slope.asDiagonal() * curvature.solve(spread.systematic(free, Eigen::all)).eval();
    fit.covariance(free, free) = covariance;
    for (std::size_t i = 0; i < free.size(); ++i) {
        const auto row = static_cast<Index>(i);
        FittedParameter& p = fit.parameters[static_cast<std::size_t>(free[i])];
        p.uRandom = std::sqrt(covariance(row, row));
        p.uSystematic = shift.row(row).norm();
        for (std::size_t k = 0; k < free.size(); ++k) {
            const auto column = static_cast<Index>(k);
            fit.correlation(free[i], free[k]) =
                covariance(row, column) /
                std::sqrt(covariance(row, row) * covariance(column, column));
        }
    }
}

void addWarnings(const NormalFit& solved, ModelFit& fit) {
    for (const FittedParameter& p : fit.parameters) {
        if (!p.measured) {
            fit.warnings.push_back(shownName(p) + " is of a band without values: " +
                                   shortest(p.lower) + " in the spec");
        }
        if (p.atLower || p.atUpper) {
            fit.warnings.push_back(shownName(p) + " is held by its " +
                                   (p.atLower ? "lower" : "upper") + " bound " +
                                   shortest(p.atLower ? p.lower : p.upper));
        }
    }
    if (solved.status == FitStatus::Singular) {
        fit.warnings.emplace_back(
            "the data do not tell all parameters apart: no covariance can be given");
        return;
    }
    constexpr double kLooseRatio = 1e8;  // of the scaled normal matrix
    if (solved.condition > kLooseRatio) {
        fit.warnings.push_back("a combination of the parameters is hardly determined (condition " +
                               shortest(std::round(std::log10(solved.condition))) + " decades)");
    }
    constexpr double kTied = 0.99;
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
        for (std::size_t k = i + 1; k < fit.parameters.size(); ++k) {
            const double r = fit.correlation(static_cast<Index>(i), static_cast<Index>(k));
            if (!(std::abs(r) > kTied)) continue;
            fit.warnings.push_back(shownName(fit.parameters[i]) + " and " +
                                   shownName(fit.parameters[k]) + " are tied: correlation " +
                                   fixed(r, 4));
        }
    }
}

/// A model against the values of rows.
struct Distance {
    double squares = 0;        ///< solid angle (f - model)^2
    double values = 0;         ///< solid angle f^2
    double energySquares = 0;  ///< likewise, times cos^2
    double energyValues = 0;
    double chiSquare = 0;
    std::size_t count = 0;
};

Distance distanceOf(const Family& family,
                    const FamilyPoint& point,
                    const BrdfData& data,
                    const Rows& rows) {
    Distance sum;
    for (const std::uint32_t i : rows) {
        const FitRow& row = data.rows[i];
        const LedBands f = family.f(point, data.nodesOf(row));
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
            if (!std::isfinite(row.f[b])) continue;
            const double r = row.f[b] - f.value[b];
            const double energy = row.solidAngle * row.cosThetaO * row.cosThetaO;
            sum.squares += row.solidAngle * r * r;
            sum.values += row.solidAngle * row.f[b] * row.f[b];
            sum.energySquares += energy * r * r;
            sum.energyValues += energy * row.f[b] * row.f[b];
            sum.chiSquare += r * r / (data.uOf(row, b) * data.uOf(row, b));
            ++sum.count;
        }
    }
    return sum;
}

void holdOut(const FitSums& sums,
             const BrdfData& data,
             const ModelFitOptions& options,
             const std::vector<double>& q,
             ModelFit& fit) {
    const std::size_t groups = data.incidences.size();
    if (options.heldOutRows == 0 || groups < 2) return;
    for (std::size_t g = 0; g < groups; ++g) {
        std::vector<bool> kept(groups, true);
        kept[g] = false;
        const Rows rows = thinnedRows(data, kept, options.heldOutRows);
        const NormalFit solved =
            solve(sums, rows, q, {.iterations = options.maxIterations, .tolerance = 1e-8});
        if (!solved.usable()) continue;
        std::vector<bool> out(groups, false);
        out[g] = true;
        Rows held;
        for (std::size_t i = 0; i < data.rows.size(); ++i) {
            if (out[data.rows[i].group]) held.push_back(static_cast<std::uint32_t>(i));
        }
        const Distance to = distanceOf(*fit.family, sums.point(solved.params), data, held);
        if (!(to.energyValues > 0)) continue;
        fit.heldOut.push_back({.incidence = data.incidences[g],
                               .rms = std::sqrt(to.squares / to.values),
                               .energyRms = std::sqrt(to.energySquares / to.energyValues),
                               .chiSquare = to.chiSquare / static_cast<double>(to.count)});
    }
    fit.allHeldOut = fit.heldOut.size() == groups;
    if (!fit.allHeldOut) {
        fit.warnings.emplace_back(
            "not every incidence can be predicted from the others: no "
            "held-out error");
    }
}

std::optional<double> rmsOf(const ModelFit& fit, double HeldOut::*member) {
    if (!fit.allHeldOut) return std::nullopt;
    double sum = 0;
    for (const HeldOut& one : fit.heldOut) sum += one.*member * one.*member;
    return std::sqrt(sum / static_cast<double>(fit.heldOut.size()));
}

/// -2 ln of the likelihood, but for what is nearly alike in all families: the determinant of the
/// covariance, in which errors are shared about each one's own model.
double deviance(const ModelFit& fit) {
    const auto n = static_cast<double>(fit.values);
    return fit.uKnown ? fit.chiSquare : n * std::log(fit.chiSquare / n);
}

/// The best of the refined starts; empty where none could be refined.
std::optional<std::vector<double>> bestStart(const Family& family,
                                             const FitSums& sums,
                                             const BrdfData& data,
                                             const ModelFitOptions& options,
                                             ModelFit& fit) {
    const Rows rows =
        thinnedRows(data, std::vector<bool>(data.incidences.size(), true), options.startRows);
    if (options.start) {
        std::vector<double> q = sums.numbersOf(*options.start);
        if (!std::isfinite(sums.solvePerBand(q, rows))) return std::nullopt;
        return q;
    }
    std::optional<std::vector<double>> best;
    double least = std::numeric_limits<double>::infinity();
    for (const Start& start : gridOfStarts(family, sums, rows)) {
        if (static_cast<std::size_t>(fit.starts) == kRefined) break;
        ++fit.starts;
        const NormalFit solved = solve(sums, rows, start.q, kRefining);
        const bool better = std::isfinite(solved.sums.cost) && solved.sums.cost < least;
        if (better) {
            least = solved.sums.cost;
            best = solved.params;
        }
        if (!best) best = start.q;
    }
    return best;
}

}  // namespace

std::size_t ModelFit::parameterCount() const {
    return static_cast<std::size_t>(std::count_if(
        parameters.begin(), parameters.end(), [](const FittedParameter& p) { return p.measured; }));
}

double ModelFit::aic() const { return deviance(*this) + 2 * static_cast<double>(parameterCount()); }

double ModelFit::bic() const {
    return deviance(*this) +
           static_cast<double>(parameterCount()) * std::log(static_cast<double>(values));
}

std::optional<double> ModelFit::heldOutRms() const { return rmsOf(*this, &HeldOut::rms); }
std::optional<double> ModelFit::heldOutEnergyRms() const {
    return rmsOf(*this, &HeldOut::energyRms);
}

ModelFit fitModel(const Family& family, const BrdfData& data, const ModelFitOptions& options) {
    FitSums sums(family, data, options);
    ModelFit fit{.family = &family};
    fit.parameters = namedParameters(family, sums, data);
    fit.values = data.valueCount();
    fit.uKnown = data.uKnown;
    fit.chiSquare = fit.condition = kNan;
    const auto n = static_cast<Index>(sums.count());
    fit.covariance = fit.correlation = Eigen::MatrixXd::Constant(n, n, kNan);
    if (fit.values <= fit.parameterCount()) {
        fit.status = FitStatus::TooFewData;
        fit.message = std::to_string(fit.values) + " values for " +
                      std::to_string(fit.parameterCount()) + " parameters";
        return fit;
    }
    const auto start = bestStart(family, sums, data, options, fit);
    if (!start) {
        fit.status = FitStatus::BadStart;
        fit.message = "no start gives a finite cost: values or uncertainties are too extreme";
        return fit;
    }
    const Rows rows = allRows(data);
    const Search search{.iterations = options.maxIterations, .tolerance = options.tolerance};
    NormalFit solved = solve(sums, rows, *start, search);
    fit.iterations = solved.iterations;
    if (solved.usable() && data.sharesErrors()) {
        sums.shareErrors(sums.point(solved.params));
        solved = solve(sums, rows, solved.params, search);
        fit.iterations += solved.iterations;
    }
    fit.status = solved.status;
    fit.message = solved.message;
    fit.condition = solved.condition;
    if (!std::isfinite(solved.sums.cost)) return fit;
    fit.point = sums.point(solved.params);
    fit.spec = family.spec(fit.point, data.bands);
    fit.chiSquare = sums.chiSquare(fit.point, rows);
    for (std::size_t i = 0; i < sums.count(); ++i) {
        FittedParameter& p = fit.parameters[i];
        if (!p.measured) continue;
        p.value = sums.toValue(i, solved.params[i]);
        const bool low = solved.params[i] - sums.lower()[i] < sums.upper()[i] - solved.params[i];
        p.atLower = solved.atBound[i] && low;
        p.atUpper = solved.atBound[i] && !low;
    }
    fillUncertainties(sums, rows, solved, fit);
    addWarnings(solved, fit);
    if (fit.usable()) holdOut(sums, data, options, solved.params, fit);
    return fit;
}

std::vector<std::array<double, 3>> normalisedResiduals(const ModelFit& fit, const BrdfData& data) {
    std::vector<std::array<double, 3>> all(data.rows.size(), {kNan, kNan, kNan});
    if (fit.point.perBand.empty()) return all;
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        const FitRow& row = data.rows[i];
        const LedBands f = fit.family->f(fit.point, data.nodesOf(row));
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
            all[i][b] = (row.f[b] - f.value[b]) / data.uOf(row, b);
        }
    }
    return all;
}

}  // namespace gonio::proc
