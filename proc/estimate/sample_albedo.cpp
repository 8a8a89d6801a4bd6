#include "proc/estimate/sample_albedo.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

BandAlbedo summed(const CellSamples& cells, std::size_t& summedCells) {
    BandAlbedo sum;
    double random = 0, systematic = 0, answered = 0;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (!cells.usable(cell) || !std::isfinite(cells.f[cell])) continue;
        const double projected = projectedSolidAngle(cell);
        sum.value += projected * cells.f[cell];
        random += std::pow(projected * cells.uRandom[cell], 2);
        systematic += projected * cells.uSystematic[cell];
        answered += projected;
        ++summedCells;
    }
    sum.missing = std::clamp(1 - answered / kPi, 0.0, 1.0);
    if (answered > 0) {
        sum.uRandom = std::sqrt(random);
        sum.uSystematic = systematic;
    } else {
        sum.value = sum.errorBound = kNan;
    }
    return sum;
}

double sin2(Radians theta) { return std::pow(sin(theta), 2); }

/// What each LED weighs in an integral over sin^2(theta_i) by the trapezoid rule.
std::vector<double> trapezoid(const std::vector<double>& at) {
    std::vector<double> weights(at.size(), 0.0);
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        const double half = (at[i + 1] - at[i]) / 2;
        weights[i] += half;
        weights[i + 1] += half;
    }
    return weights;
}

/// What the trapezoid rule may be off by: a parabola over an interval of width h departs from its
/// chord by the integral of d h^3 / 6, d half its second derivative, which the neighbours tell as a
/// second divided difference. The larger one of the two sides, and twice that.
double trapezoidError(const std::vector<double>& at, const std::vector<double>& value) {
    const std::size_t count = at.size();
    if (count < 3) return kNan;
    for (std::size_t i = 1; i < count; ++i) {
        if (!(at[i] > at[i - 1])) return kNan;
    }
    std::vector<double> bend(count, 0.0);
    for (std::size_t i = 1; i + 1 < count; ++i) {
        const double before = (value[i] - value[i - 1]) / (at[i] - at[i - 1]);
        const double after = (value[i + 1] - value[i]) / (at[i + 1] - at[i]);
        bend[i] = std::abs((after - before) / (at[i + 1] - at[i - 1]));
    }
    double error = 0;
    for (std::size_t i = 0; i + 1 < count; ++i) {
        error += 2 * std::max(bend[i], bend[i + 1]) * std::pow(at[i + 1] - at[i], 3) / 6;
    }
    return error;
}

BandAlbedo meanOf(const std::vector<Albedo>& leds,
                  const std::vector<double>& at,
                  std::size_t band) {
    std::vector<double> places, values;
    std::vector<const BandAlbedo*> known;
    for (std::size_t i = 0; i < leds.size(); ++i) {
        if (!std::isfinite(leds[i].bands[band].value)) continue;
        places.push_back(at[i]);
        values.push_back(leds[i].bands[band].value);
        known.push_back(&leds[i].bands[band]);
    }
    if (known.size() < 2) return {kNan, kNan, {}, {}, 1};
    const std::vector<double> weights = trapezoid(places);
    double value = 0, random = 0, systematic = 0, answered = 0;
    for (std::size_t i = 0; i < known.size(); ++i) {
        value += weights[i] * values[i];
        random += std::pow(weights[i] * *known[i]->uRandom, 2);
        systematic += weights[i] * *known[i]->uSystematic;
        answered += weights[i] * (1 - known[i]->missing);
    }
    return {.value = value,
            .errorBound = trapezoidError(places, values),
            .uRandom = std::sqrt(random),
            .uSystematic = systematic,
            .missing = std::clamp(1 - answered, 0.0, 1.0)};
}

/// Each rotation counts as much as another; what is common to them does not average out.
Albedo meanOverRotations(const SampleSet& sample, const std::vector<Radians>& rotations) {
    const double share = 1 / static_cast<double>(rotations.size());
    Albedo mean{.bands = {}, .evaluations = 0, .converged = true};
    for (BandAlbedo& band : mean.bands) band = {0, 0, 0.0, 0.0, 0};
    for (const Radians rotation : rotations) {
        const Albedo one = meanAlbedo(atRotation(sample, rotation));
        mean.evaluations += one.evaluations;
        for (std::size_t b = 0; b < 3; ++b) {
            BandAlbedo& band = mean.bands[b];
            band.value += share * one.bands[b].value;
            band.errorBound += share * one.bands[b].errorBound;
            *band.uRandom = std::hypot(*band.uRandom, share * one.bands[b].uRandom.value_or(kNan));
            *band.uSystematic += share * one.bands[b].uSystematic.value_or(kNan);
            band.missing += share * one.bands[b].missing;
        }
    }
    return mean;
}

}  // namespace

double projectedSolidAngle(std::size_t cell) {
    const CellBounds bounds = CellGrid::bounds(cell);
    const double width = (bounds.phiHigh - bounds.phiLow).value();
    // (sin^2 b - sin^2 a) / 2, written so that it keeps its digits near the normal.
    return width * std::sin((bounds.thetaHigh + bounds.thetaLow).value()) *
           std::sin((bounds.thetaHigh - bounds.thetaLow).value()) / 2;
}

Albedo directionalAlbedo(const LedTable& led) {
    Albedo albedo;
    for (std::size_t band = 0; band < 3; ++band) {
        albedo.bands[band] = summed(led.bands[band], albedo.evaluations);
    }
    albedo.converged = true;
    return albedo;
}

Albedo meanAlbedo(const SampleSet& sample) {
    const std::vector<Radians> rotations = rotationsOf(sample);
    if (rotations.size() > 1) return meanOverRotations(sample, rotations);
    std::vector<Albedo> leds;
    std::vector<double> at;
    Albedo mean;
    for (const LedTable& led : sample.leds) {
        leds.push_back(directionalAlbedo(led));
        at.push_back(sin2(led.incidence));
        mean.evaluations += leds.back().evaluations;
    }
    for (std::size_t band = 0; band < 3; ++band) mean.bands[band] = meanOf(leds, at, band);
    mean.converged = true;
    return mean;
}

}  // namespace gonio::proc
