#include "proc/fit/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/solve/chi_square.h"

namespace gonio::proc {
namespace {

constexpr double kRejection = 1e-3;
constexpr double kGate = 1.15;

double restRmsOf(const ModelFit& fit, const BrdfData& data) {
    const auto residuals = normalisedResiduals(fit, data);
    double rest = 0;
    double all = 0;
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        const FitRow& row = data.rows[i];
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
            if (!std::isfinite(residuals[i][b])) continue;
            const double r = residuals[i][b] * data.uOf(row, b);
            rest += row.solidAngle * r * r;
            all += row.solidAngle * row.f[b] * row.f[b];
        }
    }
    return std::sqrt(rest / all);
}

/// Regions of the reflected hemisphere that tell kinds of lobes apart.
constexpr std::array<std::string_view, 5> kRegions{"toward the light",
                                                   "about the mirror direction",
                                                   "near the normal",
                                                   "toward grazing",
                                                   "elsewhere"};

std::size_t regionOf(const Pair<double>& pair) {
    constexpr double kNear = 0.9396926207859084;   // cos 20 degrees
    constexpr double kSteep = 0.3420201433256687;  // cos 70 degrees
    const double back = dot(pair.in, pair.out);
    const double mirror = pair.in.z * pair.out.z - pair.in.x * pair.out.x - pair.in.y * pair.out.y;
    if (back > kNear && back > mirror) return 0;
    if (mirror > kNear) return 1;
    if (pair.out.z > kNear) return 2;
    return pair.out.z < kSteep ? 3 : 4;
}

std::vector<Misfit> worstRegions(const ModelFit& fit, const BrdfData& data) {
    struct Sum {
        double squares = 0, f = 0, model = 0;
        std::size_t count = 0;
    };
    std::vector<std::array<Sum, kRegions.size()>> sums(data.incidences.size());
    const auto residuals = normalisedResiduals(fit, data);
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        const FitRow& row = data.rows[i];
        Sum& sum = sums[row.group][regionOf(data.nodes[row.firstNode].pair)];
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
            const double r = residuals[i][b];
            if (!std::isfinite(r)) continue;
            sum.squares += r * r;
            sum.f += row.f[b];
            sum.model += row.f[b] - r * data.uOf(row, b);
            ++sum.count;
        }
    }
    std::vector<Misfit> all;
    for (std::size_t g = 0; g < sums.size(); ++g) {
        for (std::size_t k = 0; k < kRegions.size(); ++k) {
            const Sum& sum = sums[g][k];
            if (sum.count == 0) continue;
            all.push_back({.incidence = data.incidences[g],
                           .region = std::string(kRegions[k]),
                           .chiSquare = sum.squares / static_cast<double>(sum.count),
                           .meanRatio = sum.f / sum.model,
                           .values = sum.count});
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const Misfit& a, const Misfit& b) {
        return a.chiSquare * static_cast<double>(a.values) >
               b.chiSquare * static_cast<double>(b.values);
    });
    return all;
}

double gateFor(double dof) { return std::max(kGate, 1 + 5 * std::sqrt(2 / std::max(dof, 1.0))); }

/// What a row and band give to the comparison of a distance with the systematic uncertainty.
struct DistanceSquared {
    double distance = 0;  ///< may be below 0 where noise is taken off
    double u = 0;
};

/// The largest root, over the regions of each incidence and band, of the mean square distance over
/// the mean square uncertainty; infinite where there is a distance and no uncertainty.
template <class Squares>
double largestOfRegions(const BrdfData& data, Squares&& squares) {
    std::vector<std::array<std::array<DistanceSquared, 3>, kRegions.size()>> sums(
        data.incidences.size());
    for (const FitRow& row : data.rows) {
        auto& ofRegion = sums[row.group][regionOf(data.nodes[row.firstNode].pair)];
        const std::array<double, 3> all = squares(row);
        for (std::size_t band = 0; band < data.bandsUsed(); ++band) {
            if (!std::isfinite(row.f[band])) continue;
            ofRegion[band].distance += all[band];
            ofRegion[band].u += squared(row.uSystematic[band]);
        }
    }
    double largest = 0;
    for (const auto& group : sums) {
        for (const auto& region : group) {
            for (const DistanceSquared& sum : region) {
                if (!(sum.distance > 0)) continue;
                largest = std::max(
                    largest,
                    sum.u > 0 ? sum.distance / sum.u : std::numeric_limits<double>::infinity());
            }
        }
    }
    return std::sqrt(largest);
}

/// RankedFit::apart.
double apartInSystematic(const ModelFit& a, const ModelFit& b, const BrdfData& data) {
    return largestOfRegions(data, [&](const FitRow& row) {
        const LedBands fa = a.family->f(a.point, data.nodesOf(row));
        const LedBands fb = b.family->f(b.point, data.nodesOf(row));
        std::array<double, 3> all{};
        for (std::size_t band = 0; band < data.bandsUsed(); ++band) {
            all[band] = squared(fa.value[band] - fb.value[band]);
        }
        return all;
    });
}

/// By how much the data differ from a fit beyond their other uncertainties, in the same units.
double misfitInSystematic(const ModelFit& fit, const BrdfData& data) {
    return largestOfRegions(data, [&](const FitRow& row) {
        const LedBands f = fit.family->f(fit.point, data.nodesOf(row));
        std::array<double, 3> all{};
        for (std::size_t band = 0; band < data.bandsUsed(); ++band) {
            all[band] = squared(row.f[band] - f.value[band]) - squared(data.uOf(row, band));
        }
        return all;
    });
}

/// At least as good in all three, better in one.
bool dominates(const RankedFit& a, const RankedFit& b) {
    // Told apart by time only where both have been timed.
    const double timeA = b.nanoseconds ? a.nanoseconds.value_or(0) : 0;
    const double timeB = a.nanoseconds ? b.nanoseconds.value_or(0) : 0;
    const std::size_t countA = a.fit.parameterCount();
    const std::size_t countB = b.fit.parameterCount();
    const bool noWorse = a.error() <= b.error() && countA <= countB && timeA <= timeB;
    return noWorse && (a.error() < b.error() || countA < countB || timeA < timeB);
}

void markPareto(std::vector<RankedFit>& ranked) {
    for (RankedFit& one : ranked) {
        one.pareto = one.fit.usable() &&
                     std::none_of(ranked.begin(), ranked.end(), [&](const RankedFit& other) {
                         return other.fit.usable() && dominates(other, one);
                     });
    }
}

void judge(Selection& selection, const BrdfData& data) {
    std::vector<RankedFit>& ranked = selection.ranked;
    for (std::size_t i = 0; i < ranked.size(); ++i) {
        if (!ranked[i].fit.usable()) continue;
        const bool better =
            !selection.best || ranked[i].fit.chiSquare < ranked[*selection.best].fit.chiSquare;
        if (better) selection.best = i;
    }
    if (!selection.best) {
        selection.verdict = "no family could be fitted";
        return;
    }
    const ModelFit& best = ranked[*selection.best].fit;
    const double perDof = best.chiSquarePerDof();
    selection.gate = gateFor(best.degreesOfFreedom());
    selection.worst = worstRegions(best, data);
    const double noise = std::max(1.0, perDof);
    for (RankedFit& one : ranked) {
        if (!one.fit.usable()) continue;
        const double more = static_cast<double>(best.parameterCount()) -
                            static_cast<double>(one.fit.parameterCount());
        const double worse = (one.fit.chiSquare - best.chiSquare) / noise;
        one.probability = chiSquareTail(worse, std::max(1.0, more));
        one.rejected = !(one.probability >= kRejection);
        one.apart = apartInSystematic(one.fit, best, data);
        if (one.apart < 1) one.rejected = false;
    }
    const std::string against =
        data.uKnown ? "the noise"
                    : "an assumed uncertainty of " + perCent(data.assumedRelative) + " of f";
    selection.misfit = misfitInSystematic(best, data);
    if (perDof > selection.gate && !(selection.misfit < 1)) {
        const Misfit& where = selection.worst.front();
        selection.verdict = "none fits: the best, " + best.family->name() + ", misfits by " +
                            fixed(perDof, 2) + " times " + against + " squared (limit " +
                            fixed(selection.gate, 2) + "), most " + where.region + " at " +
                            fixed(where.incidence.degrees(), 1) + " deg, where " +
                            (std::isfinite(where.meanRatio)
                                 ? "f is " + fixed(where.meanRatio, 2) + " times the model"
                                 : "the model is 0");
        return;
    }
    for (std::size_t i = 0; i < ranked.size(); ++i) {
        if (ranked[i].rejected || !ranked[i].fit.usable()) continue;
        const auto key = [&](std::size_t k) {
            return std::pair(ranked[k].fit.parameterCount(), ranked[k].fit.chiSquare);
        };
        if (!selection.chosen || key(i) < key(*selection.chosen)) selection.chosen = i;
    }
    const ModelFit& chosen = ranked[*selection.chosen].fit;
    selection.verdict = chosen.family->name() + " is the simplest that " +
                        (data.uKnown ? "the uncertainties" : against) +
                        " cannot reject: chi-square per degree of freedom " +
                        fixed(chosen.chiSquarePerDof(), 3) + ", " +
                        std::to_string(chosen.parameterCount()) + " parameters";
}

Selection ranked(std::vector<ModelFit> fits,
                 const BrdfData& data,
                 const SelectionOptions& options) {
    Selection selection;
    for (ModelFit& fit : fits) {
        RankedFit one;
        one.fit = std::move(fit);
        if (one.fit.usable()) {
            one.restRms = restRmsOf(one.fit, data);
            if (options.nanoseconds) one.nanoseconds = options.nanoseconds(one.fit.spec);
        }
        selection.ranked.push_back(std::move(one));
    }
    const bool anyHeldOut =
        std::any_of(selection.ranked.begin(), selection.ranked.end(), [](const RankedFit& one) {
            return one.fit.heldOutEnergyRms().has_value();
        });
    for (RankedFit& one : selection.ranked) one.byRest = !anyHeldOut;
    std::stable_sort(selection.ranked.begin(),
                     selection.ranked.end(),
                     [](const RankedFit& a, const RankedFit& b) {
                         if (a.fit.usable() != b.fit.usable()) return a.fit.usable();
                         return a.fit.usable() && a.error() < b.error();
                     });
    markPareto(selection.ranked);
    judge(selection, data);
    return selection;
}

}  // namespace

double RankedFit::error() const {
    if (byRest) return restRms;
    return fit.heldOutEnergyRms().value_or(std::numeric_limits<double>::infinity());
}

Selection selectModel(const std::vector<const Family*>& families,
                      const BrdfData& data,
                      const SelectionOptions& options) {
    std::vector<ModelFit> fits(families.size());
    parallelFor(families.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            fits[i] = fitModel(*families[i], data, options.fit);
        }
    });
    return ranked(std::move(fits), data, options);
}

Selection selectAmong(std::vector<ModelFit> fits, const BrdfData& data) {
    return ranked(std::move(fits), data, {});
}

}  // namespace gonio::proc
