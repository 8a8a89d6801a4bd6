#include "proc/estimate/interpolation_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "proc/core/parallel.h"
#include "proc/optics/cell_grid.h"
#include "proc/solve/quadrature.h"

namespace gonio::proc {
namespace {

Direction lightAt(Radians incidence) { return Direction::fromSpherical(incidence, Radians(0)); }

LedBands cellMean(const Scatterer& truth, const Direction& wi, std::size_t cell) {
    static const std::vector<QuadratureNode> rule = gaussLegendre(4);
    const CellBounds bounds = CellGrid::bounds(cell);
    const double theta = (bounds.thetaHigh - bounds.thetaLow).value();
    const double phi = (bounds.phiHigh - bounds.phiLow).value();
    LedBands sum;
    double weights = 0;
    for (const QuadratureNode& a : rule) {
        const double thetaO = bounds.thetaLow.value() + a.x * theta;
        for (const QuadratureNode& b : rule) {
            const Direction wo = Direction::fromSpherical(
                Radians(thetaO), Radians(bounds.phiLow.value() + b.x * phi));
            const double weight = a.weight * b.weight * std::sin(thetaO);
            sum = sum + truth.answer({.in = wi, .out = wo}).f * weight;
            weights += weight;
        }
    }
    return sum * (1 / weights);
}

LedTable ledOf(const Scatterer& truth, Radians incidence, const SyntheticOptions& options) {
    LedTable led;
    led.incidence = incidence;
    for (CellSamples& cells : led.bands) cells = CellSamples::missing(CellGrid::count());
    const Direction wi = lightAt(incidence);
    parallelFor(CellGrid::count(), [&](IndexRange range) {
        for (std::size_t cell = range.begin; cell < range.end; ++cell) {
            if (CellGrid::place(cell).row >= options.rows) continue;
            const LedBands f = cellMean(truth, wi, cell);
            for (std::size_t b = 0; b < 3; ++b) {
                CellSamples& cells = led.bands[b];
                cells.f[cell] = f.value[b];
                const double relative = std::max(options.relativeNoise, options.leastRelative);
                cells.uRandom[cell] = relative * f.value[b] + 1e-6;
                cells.uSystematic[cell] = 0;
                cells.nEff[cell] = 1;
                cells.flags[cell] = Flags{Flag::Measured};
            }
        }
    });
    return led;
}

void addNoise(SampleSet& set, const SyntheticOptions& options) {
    std::mt19937_64 random(options.seed);
    std::normal_distribution<double> normal;
    for (LedTable& led : set.leds) {
        for (CellSamples& cells : led.bands) {
            for (double& f : cells.f) f *= 1 + options.relativeNoise * normal(random);
        }
    }
}

/// Sums over directions and bands.
struct Tally {
    double all = 0, allWeight = 0;
    double lobe = 0, lobeWeight = 0;
    double within = 0, stated = 0;
    double missing = 0, count = 0;

    void add(const Answer& answer, const LedBands& truth, const LedBands& peak, double weight) {
        constexpr double kDarkest = 1e-5;  // 1/sr: darker is beyond what a rig measures
        for (const Band band : kBands) {
            if (!(truth[band] >= kDarkest)) continue;  // or the truth does not say
            ++count;
            const double f = answer.f[band];
            if (std::isnan(f)) {
                ++missing;
                continue;
            }
            const double error = (f - truth[band]) / truth[band];
            all += weight * error * error;
            allWeight += weight;
            if (truth[band] > 0.1 * peak[band]) {
                lobe += weight * error * error;
                lobeWeight += weight;
            }
            const auto u = answer.u(band);
            if (!u) continue;
            ++stated;
            if (std::abs(f - truth[band]) <= 2 * *u) ++within;
        }
    }
};

std::vector<std::size_t> cellsOf(const Asked& asked) {
    std::vector<std::size_t> cells;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        const int row = CellGrid::place(cell).row;
        if (row >= asked.firstRow && row < asked.lastRow) cells.push_back(cell);
    }
    return cells;
}

}  // namespace

SampleSet syntheticSample(const Scatterer& truth, const SyntheticOptions& options) {
    SampleSet set;
    for (const Radians incidence : options.incidences) {
        set.leds.push_back(ledOf(truth, incidence, options));
    }
    if (options.relativeNoise > 0) addNoise(set, options);
    return set;
}

std::vector<LightView> askedPairs(const Asked& asked) {
    const std::vector<std::size_t> cells = cellsOf(asked);
    std::vector<LightView> pairs;
    for (const Radians incidence : asked.incidences) {
        for (std::size_t i = 0; i < cells.size(); i += static_cast<std::size_t>(asked.stride)) {
            pairs.push_back({.in = lightAt(incidence), .out = CellGrid::centre(cells[i])});
        }
    }
    return pairs;
}

double microsecondsPerAnswer(const Scatterer& estimator,
                             const std::vector<LightView>& pairs,
                             const Clock& clock) {
    if (pairs.empty()) return 0;
    std::vector<double> kept(pairs.size());  // so that no answer can be left out
    const Stopwatch watch(clock);
    parallelFor(pairs.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            kept[i] = estimator.answer(pairs[i]).f[Band::R];
        }
    });
    return watch.elapsed().count() / static_cast<double>(pairs.size()) * 1e6;
}

RegionError errorOf(const Scatterer& estimator, const Scatterer& truth, const Asked& asked) {
    Tally tally;
    for (const Radians incidence : asked.incidences) {
        const Direction wi = lightAt(incidence);
        const std::vector<std::size_t> cells = cellsOf(asked);
        std::vector<LedBands> true_(cells.size());
        std::vector<Answer> answers(cells.size());
        parallelFor(cells.size(), [&](IndexRange range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const LightView pair{.in = wi, .out = CellGrid::centre(cells[i])};
                true_[i] = truth.answer(pair).f;
                if (i % static_cast<std::size_t>(asked.stride) == 0) {
                    answers[i] = estimator.answer(pair);
                }
            }
        });
        LedBands peak;
        for (const LedBands& f : true_) {
            for (const Band band : kBands) peak[band] = std::max(peak[band], f[band]);
        }
        for (std::size_t i = 0; i < cells.size(); i += static_cast<std::size_t>(asked.stride)) {
            tally.add(answers[i], true_[i], peak, CellGrid::solidAngle(cells[i]));
        }
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {.hemisphere = tally.allWeight > 0 ? std::sqrt(tally.all / tally.allWeight) : nan,
            .lobe = tally.lobeWeight > 0 ? std::sqrt(tally.lobe / tally.lobeWeight) : nan,
            .within2u = tally.stated > 0 ? tally.within / tally.stated : nan,
            .unanswered = tally.count > 0 ? tally.missing / tally.count : nan};
}

}  // namespace gonio::proc
