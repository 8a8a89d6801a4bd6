#include "proc/fit/model_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "proc/core/number_text.h"
#include "proc/fit/fit_sums.h"

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
    for (std::size_t i = 0; i < sums.count(); ++i) first[i] = sums.parameter(i).starts.front();
    std::vector<std::vector<double>> grid{first};
    for (std::size_t i = 0; i < family.sharedCount(); ++i) {
        const FamilyParameter& p = sums.parameter(i);
        std::vector<std::vector<double>> wider;
        for (const std::vector<double>& at : grid) {
            for (const double value : p.starts) {
                // Two lobes of one kind, and the two widths of one: the narrower comes first.
                const bool twin = i > 0 && sums.parameter(i - 1).scale == p.scale &&
                                  p.scale == ParameterScale::Log;
                if (twin && value < std::exp(at[i - 1])) continue;
                wider.push_back(at);
                wider.back()[i] = p.scale == ParameterScale::Log ? std::log(value) : value;
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

/// Rows that a start is judged by: a fit to few rows of a family with many parameters would not
/// tell one from another.
Rows startRows(const BrdfData& data, const ModelFitOptions& options) {
    return thinnedRows(data, std::vector<bool>(data.incidences.size(), true), options.startRows);
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
        named.value = named.uRandom = named.uSystematic = kNan;
        all.push_back(std::move(named));
    }
    return all;
}

std::string shownName(const FittedParameter& p) {
    return p.band ? p.name + "_" + std::string(letter(*p.band)) : p.name;
}

/// (J^T W J)^-1 J^T W^2 J (J^T W J)^-1 of the free parameters, and the shift that the systematic
/// uncertainties cause, as parameter values.
void fillUncertainties(const FitSums& sums,
                       const Rows& rows,
                       const NormalFit& solved,
                       const BrdfData& data,
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
    const Eigen::MatrixXd inverse = solved.covariance(free, free);
    Eigen::VectorXd slope(static_cast<Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i) {
        const auto place = static_cast<std::size_t>(free[i]);
        slope(static_cast<Index>(i)) = sums.slope(place, solved.params[place]);
    }
    const Eigen::MatrixXd toValues = slope.asDiagonal() * inverse;
    const double scale = data.uKnown ? 1 : std::max(fit.chiSquarePerDof(), 0.0);
    const bool plain = sums.byCovariance();
    const Eigen::MatrixXd covariance =
        plain
            ? Eigen::MatrixXd(scale * toValues * slope.asDiagonal())
            : Eigen::MatrixXd(scale * toValues * spread.squared(free, free) * toValues.transpose());
    // Of a fit without the shared errors: with them an LED's offset would take up what is common.
    const Eigen::MatrixXd shift =
        slope.asDiagonal() *
        spread.plain(free, free).ldlt().solve(spread.systematic(free, Eigen::all)).eval();
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

/// The model over the nodes of a row, against its values.
struct Misfit {
    double squares = 0;        ///< solid angle (f - model)^2
    double values = 0;         ///< solid angle f^2
    double energySquares = 0;  ///< likewise, times cos^2
    double energyValues = 0;
    double chiSquare = 0;
    std::size_t count = 0;
};

Misfit misfitOf(const Family& family,
                const FamilyPoint& point,
                const BrdfData& data,
                const Rows& rows) {
    Misfit sum;
    for (const std::uint32_t i : rows) {
        const FitRow& row = data.rows[i];
        const LedBands f =
            family.f(point, std::span(data.nodes.data() + row.firstNode, row.nodeCount));
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
            if (!std::isfinite(row.f[b])) continue;
            const double r = row.f[b] - f.value[b];
            const double energy = row.solidAngle * row.cosThetaO * row.cosThetaO;
            sum.squares += row.solidAngle * r * r;
            sum.values += row.solidAngle * row.f[b] * row.f[b];
            sum.energySquares += energy * r * r;
            sum.energyValues += energy * row.f[b] * row.f[b];
            sum.chiSquare += r * r / (row.uRandom[b] * row.uRandom[b]);
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
        const Misfit misfit = misfitOf(*fit.family, sums.point(solved.params), data, held);
        if (misfit.count == 0) continue;
        fit.heldOut.push_back({.incidence = data.incidences[g],
                               .rms = std::sqrt(misfit.squares / misfit.values),
                               .energyRms = std::sqrt(misfit.energySquares / misfit.energyValues),
                               .chiSquare = misfit.chiSquare / static_cast<double>(misfit.count)});
    }
}

bool sharesErrors(const BrdfData& data) {
    return std::any_of(data.rows.begin(), data.rows.end(), [](const FitRow& row) {
        return std::any_of(row.uState.begin(), row.uState.end(), [](double u) { return u > 0; });
    });
}

std::optional<double> rmsOf(const std::vector<HeldOut>& all, double HeldOut::*member) {
    if (all.empty()) return std::nullopt;
    double sum = 0;
    for (const HeldOut& one : all) sum += one.*member * one.*member;
    return std::sqrt(sum / static_cast<double>(all.size()));
}

/// The best of the refined starts; empty where none could be refined.
std::optional<std::vector<double>> bestStart(const Family& family,
                                             const FitSums& sums,
                                             const BrdfData& data,
                                             const ModelFitOptions& options,
                                             ModelFit& fit) {
    const Rows rows = startRows(data, options);
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

double ModelFit::aic() const { return chiSquare + 2 * static_cast<double>(parameters.size()); }

double ModelFit::bic() const {
    return chiSquare +
           static_cast<double>(parameters.size()) * std::log(static_cast<double>(values));
}

std::optional<double> ModelFit::heldOutRms() const { return rmsOf(heldOut, &HeldOut::rms); }
std::optional<double> ModelFit::heldOutEnergyRms() const {
    return rmsOf(heldOut, &HeldOut::energyRms);
}

ModelFit fitModel(const Family& family, const BrdfData& data, const ModelFitOptions& options) {
    FitSums sums(family, data, options);
    ModelFit fit{.family = &family};
    fit.parameters = namedParameters(family, sums, data);
    fit.values = data.valueCount();
    fit.chiSquare = fit.condition = kNan;
    const auto n = static_cast<Index>(sums.count());
    fit.covariance = fit.correlation = Eigen::MatrixXd::Constant(n, n, kNan);
    if (fit.values < sums.count()) {
        fit.status = FitStatus::TooFewData;
        fit.message = std::to_string(fit.values) + " values for " + std::to_string(sums.count()) +
                      " parameters";
        return fit;
    }
    const auto start = bestStart(family, sums, data, options, fit);
    if (!start) {
        fit.status = FitStatus::BadStart;
        fit.message = "the model is not finite at any start";
        return fit;
    }
    const Rows rows = allRows(data);
    NormalFit solved = solve(sums, rows, *start, {.iterations = options.maxIterations});
    fit.iterations = solved.iterations;
    if (solved.usable() && sharesErrors(data)) {
        sums.shareErrors(sums.point(solved.params));
        solved = solve(sums, rows, solved.params, {.iterations = options.maxIterations});
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
        p.value = sums.toValue(i, solved.params[i]);
        const bool low = solved.params[i] - sums.lower()[i] < sums.upper()[i] - solved.params[i];
        p.atLower = solved.atBound[i] && low;
        p.atUpper = solved.atBound[i] && !low;
    }
    fillUncertainties(sums, rows, solved, data, fit);
    addWarnings(solved, fit);
    if (fit.usable()) holdOut(sums, data, options, solved.params, fit);
    return fit;
}

std::vector<std::array<double, 3>> normalisedResiduals(const ModelFit& fit, const BrdfData& data) {
    std::vector<std::array<double, 3>> all(data.rows.size(), {kNan, kNan, kNan});
    if (fit.point.perBand.empty()) return all;
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        const FitRow& row = data.rows[i];
        const LedBands f =
            fit.family->f(fit.point, std::span(data.nodes.data() + row.firstNode, row.nodeCount));
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
            all[i][b] = (row.f[b] - f.value[b]) / row.uRandom[b];
        }
    }
    return all;
}

}  // namespace gonio::proc
