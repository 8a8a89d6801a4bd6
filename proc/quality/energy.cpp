#include "proc/quality/energy.h"

#include <algorithm>
#include <cmath>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

struct Albedo {
    Measured<double> fraction;
    std::string state;
    /// Above 1, in standard uncertainties.
    [[nodiscard]] double excess() const { return (fraction.value - 1) / fraction.u(); }
};

/// Of the state that is furthest above 1, or nearest to it.
std::optional<Albedo> worstOf(const SampleSet& sample) {
    std::optional<Albedo> worst;
    for (std::size_t led = 0; led < sample.leds.size(); ++led) {
        for (const Band band : kBands) {
            const auto fraction = reflectedFraction(sample.leds[led].bands[index(band)]);
            if (!fraction) continue;
            const Albedo one{*fraction,
                             "LED " + std::to_string(led) + " " + std::string(letter(band))};
            if (!worst || one.excess() > worst->excess()) worst = one;
        }
    }
    return worst;
}

}  // namespace

std::optional<Measured<double>> reflectedFraction(const CellSamples& cells) {
    double sum = 0, random = 0, systematic = 0;
    bool any = false;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (!cells.present(cell)) continue;
        const double weight = CellGrid::centre(cell).z() * CellGrid::solidAngle(cell);
        sum += weight * cells.f[cell];
        random += std::pow(weight * cells.uRandom[cell], 2);
        systematic += weight * cells.uSystematic[cell];
        any = true;
    }
    if (!any) return std::nullopt;
    return Measured<double>{.value = sum, .uRandom = std::sqrt(random), .uSystematic = systematic};
}

Verdict energyVerdict(const SampleSet& sample, const QualityLimits& limits) {
    Verdict verdict{.name = "energy", .figure = {}, .evidence = "no cell was measured", .next = {}};
    const std::optional<Albedo> worst = worstOf(sample);
    if (!worst) return verdict;
    const double u = worst->fraction.u();
    const double limit = 1 + limits.energySure * u;
    verdict.figure = Figure{.value = worst->fraction.value, .u = u, .unit = "1", .limit = limit};
    const bool tooMuch = worst->fraction.value > limit;
    verdict.grade = tooMuch ? Grade::Refused : Grade::Ok;
    verdict.evidence = worst->state + " sends " + amount(worst->fraction.value, "1") +
                       " of its light into the measured field";
    if (tooMuch) {
        verdict.evidence = "more light than fell on the sample: " + verdict.evidence;
        verdict.next = "calibrate white again; a sample that fluoresces has no BRDF";
    }
    return verdict;
}

}  // namespace gonio::proc
