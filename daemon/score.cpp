#include "daemon/score.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "proc/core/parallel.h"
#include "proc/optics/cell_grid.h"

namespace gonio::daemon {
namespace {

constexpr double kLowestF = 1e-2;           // 1/sr
constexpr double kSteepestPerDegree = 0.2;  // relative
constexpr int kSubdivisions = 6;            // of a cell, each way: midpoint rule

struct Deviation {
    double relative = 0;
    bool within2u = false;
    bool within2uRandom = false;
};

/// Mean of the truth over the cell, per band; empty where any part of it has no truth.
std::optional<LedBands> cellMean(const Scatterer& truth,
                                 const proc::LedTable& led,
                                 std::size_t cell) {
    const auto bounds = proc::CellGrid::bounds(cell);
    const double cosTop = cos(bounds.thetaLow);
    const double cosBottom = cos(bounds.thetaHigh);
    LedBands sum;
    for (int i = 0; i < kSubdivisions; ++i) {
        const double c = cosTop + (cosBottom - cosTop) * (i + 0.5) / kSubdivisions;  // equal areas
        const Radians theta(std::acos(c));
        for (int j = 0; j < kSubdivisions; ++j) {
            const Radians phi =
                bounds.phiLow + (bounds.phiHigh - bounds.phiLow) * ((j + 0.5) / kSubdivisions);
            const Answer answer =
                truth.answer(proc::pairInSample(led, Direction::fromSpherical(theta, phi)));
            if (!answer.present()) return std::nullopt;
            sum = sum + answer.f;
        }
    }
    return sum * (1.0 / (kSubdivisions * kSubdivisions));
}

/// Relative slope of the truth at the cell's centre, 1/degree, per band: central differences over
/// one degree along theta and along phi. Empty where a neighbour has no truth.
std::optional<LedBands> relativeSlope(const Scatterer& truth,
                                      const proc::LedTable& led,
                                      std::size_t cell) {
    const Direction centre = proc::CellGrid::centre(cell);
    const Radians theta = centre.theta();
    const Radians phi = centre.phi();
    const Radians half = 0.5_deg;
    const Radians across(half.value() / std::max(sin(theta), 1e-3));
    const auto at = [&](Radians t, Radians p) {
        return truth.answer(proc::pairInSample(led, Direction::fromSpherical(t, p)));
    };
    const Answer here = at(theta, phi);
    const Answer up = at(theta + half, phi);
    const Answer down = at(theta - half, phi);
    const Answer left = at(theta, phi + across);
    const Answer right = at(theta, phi - across);
    if (!here.present() || !up.present() || !down.present() || !left.present() ||
        !right.present()) {
        return std::nullopt;
    }
    LedBands slope;
    for (Band b : kBands) {
        slope[b] = std::hypot(up.f[b] - down.f[b], left.f[b] - right.f[b]) / here.f[b];
    }
    return slope;
}

void collect(const proc::LedTable& led,
             const Scatterer& truth,
             std::size_t cell,
             std::vector<Deviation>& out) {
    const bool any = std::any_of(led.bands.begin(), led.bands.end(), [&](const auto& band) {
        return cell < band.size() && band.present(cell);
    });
    if (!any) return;
    const auto mean = cellMean(truth, led, cell);
    const auto slope = relativeSlope(truth, led, cell);
    if (!mean || !slope) return;
    for (Band b : kBands) {
        const proc::CellSamples& samples = led.bands[index(b)];
        if (cell >= samples.size() || !samples.present(cell)) continue;
        if (!((*mean)[b] >= kLowestF) || !((*slope)[b] <= kSteepestPerDegree)) continue;
        const double error = std::abs(samples.f[cell] - (*mean)[b]);
        const double u = std::hypot(samples.uRandom[cell], samples.uSystematic[cell]);
        out.push_back({error / (*mean)[b], error <= 2 * u, error <= 2 * samples.uRandom[cell]});
    }
}

double quantile(std::vector<double>& sorted, double q) {
    if (sorted.empty()) return std::nan("");
    const auto at = static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1));
    return sorted[at];
}

}  // namespace

Score score(const proc::SampleSet& measured, const Scatterer& truth) {
    std::vector<Deviation> all;
    std::mutex guard;
    for (const proc::LedTable& led : measured.leds) {
        parallelFor(proc::CellGrid::count(), [&](IndexRange cells) {
            std::vector<Deviation> mine;
            for (std::size_t cell = cells.begin; cell < cells.end; ++cell) {
                collect(led, truth, cell, mine);
            }
            const std::scoped_lock lock(guard);
            all.insert(all.end(), mine.begin(), mine.end());
        });
    }
    std::vector<double> errors;
    Score result;
    result.cells = static_cast<int>(all.size());
    double inside = 0;
    double insideRandom = 0;
    for (const Deviation& d : all) {
        errors.push_back(d.relative);
        inside += d.within2u ? 1 : 0;
        insideRandom += d.within2uRandom ? 1 : 0;
    }
    std::sort(errors.begin(), errors.end());
    result.medianRelativeError = quantile(errors, 0.5);
    result.p95RelativeError = quantile(errors, 0.95);
    const double n = std::max<double>(1, static_cast<double>(all.size()));
    result.within2u = inside / n;
    result.within2uRandom = insideRandom / n;
    return result;
}

}  // namespace gonio::daemon
