#include "proc/estimate/sample_albedo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/parallel.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The sum over cells of one band.
class CellSum {
public:
    void add(std::size_t cell, double f, std::optional<double> uRandom, double uSystematic) {
        const double projected = projectedSolidAngle(cell);
        value_ += projected * f;
        known_ = known_ && uRandom.has_value();
        random_ += std::pow(projected * uRandom.value_or(0), 2);
        systematic_ += projected * uSystematic;
        answered_ += projected;
    }
    void add(std::size_t cell, const CellSamples& cells) {
        add(cell, cells.f[cell], cells.uRandom[cell], cells.uSystematic[cell]);
    }
    [[nodiscard]] BandAlbedo albedo() const {
        BandAlbedo sum{.value = value_, .missing = std::clamp(1 - answered_ / kPi, 0.0, 1.0)};
        if (answered_ <= 0) {
            sum.value = sum.errorBound = kNan;
        } else if (known_) {
            sum.uRandom = std::sqrt(random_);
            sum.uSystematic = systematic_;
        }
        return sum;
    }

private:
    double value_ = 0, random_ = 0, systematic_ = 0, answered_ = 0;
    bool known_ = true;
};

bool counts(const CellSamples& cells, std::size_t cell) {
    return cell < cells.size() && cells.usable(cell) && std::isfinite(cells.f[cell]);
}

BandAlbedo summed(const CellSamples& cells, std::size_t& summedCells) {
    CellSum sum;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (!counts(cells, cell)) continue;
        sum.add(cell, cells);
        ++summedCells;
    }
    return sum.albedo();
}

/// At the centres of the cells that some band lacks; elsewhere nothing.
std::vector<Answer> answersAtHoles(const LedTable& led, const Scatterer& beyond) {
    std::vector<Answer> answers(CellGrid::count(), Answer::none({}, Source::Measured));
    parallelFor(answers.size(), [&](IndexRange range) {
        for (std::size_t cell = range.begin; cell < range.end; ++cell) {
            const bool whole = std::all_of(led.bands.begin(),
                                           led.bands.end(),
                                           [&](const auto& own) { return counts(own, cell); });
            if (!whole) answers[cell] = beyond.answer(pairInSample(led, CellGrid::centre(cell)));
        }
    });
    return answers;
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

Albedo averagedAlbedo(const std::vector<Albedo>& rotations) {
    const double share = 1 / static_cast<double>(rotations.size());
    Albedo mean{.bands = {}, .evaluations = 0, .converged = true};
    for (BandAlbedo& band : mean.bands) band = {0, 0, 0.0, 0.0, 0};
    for (const Albedo& one : rotations) {
        mean.evaluations += one.evaluations;
        mean.converged = mean.converged && one.converged;
        for (std::size_t b = 0; b < 3; ++b) {
            BandAlbedo& band = mean.bands[b];
            band.value += share * one.bands[b].value;
            band.errorBound += share * one.bands[b].errorBound;
            band.missing += share * one.bands[b].missing;
            if (band.uRandom && one.bands[b].uRandom) {
                band.uRandom = std::hypot(*band.uRandom, share * *one.bands[b].uRandom);
            } else {
                band.uRandom.reset();
            }
            if (band.uSystematic && one.bands[b].uSystematic) {
                *band.uSystematic += share * *one.bands[b].uSystematic;
            } else {
                band.uSystematic.reset();
            }
        }
    }
    return mean;
}

Albedo filledAlbedo(const LedTable& led, const Scatterer& beyond) {
    const std::vector<Answer> answers = answersAtHoles(led, beyond);
    Albedo albedo;
    for (const Band band : kBands) {
        const CellSamples& cells = led.bands[index(band)];
        CellSum sum;
        for (std::size_t cell = 0; cell < answers.size(); ++cell) {
            const Answer& answer = answers[cell];
            if (counts(cells, cell)) {
                sum.add(cell, cells);
            } else if (std::isfinite(answer.f[band])) {
                const bool known = answer.uRandom && answer.uSystematic;
                sum.add(cell,
                        answer.f[band],
                        known ? std::optional((*answer.uRandom)[band]) : std::nullopt,
                        known ? (*answer.uSystematic)[band] : 0);
            }
        }
        albedo.bands[index(band)] = sum.albedo();
    }
    albedo.evaluations = answers.size();
    albedo.converged = true;
    return albedo;
}

Albedo meanAlbedo(const SampleSet& sample) {
    const std::vector<Radians> rotations = rotationsOf(sample);
    if (rotations.size() > 1) {
        std::vector<Albedo> each;
        for (const Radians one : rotations) each.push_back(meanAlbedo(tablesAt(sample, one)));
        return averagedAlbedo(each);
    }
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
