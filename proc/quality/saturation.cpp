#include "proc/quality/saturation.h"

#include "proc/optics/cell_grid.h"

namespace gonio::proc {

double saturatedShare(const CellSamples& cells) {
    double lost = 0, measured = 0;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const double omega = CellGrid::solidAngle(cell);
        if (cells.present(cell)) {
            measured += omega;
        } else if (cells.flags[cell].has(Flag::Saturated)) {
            lost += omega;
        }
    }
    return lost > 0 ? lost / (lost + measured) : 0;
}

Verdict saturationVerdict(const SampleSet& sample, const QualityLimits& limits) {
    Figure worst{.value = 0, .u = {}, .unit = "1"};
    std::string state;
    for (std::size_t led = 0; led < sample.leds.size(); ++led) {
        for (const Band band : kBands) {
            const double share = saturatedShare(sample.leds[led].bands[index(band)]);
            if (share <= worst.value) continue;
            worst.value = share;
            state = "LED " + std::to_string(led) + " " + std::string(letter(band));
        }
    }
    Verdict verdict{.name = "saturation", .figure = {}, .evidence = "no cell was lost", .next = {}};
    verdict.grade = graded(worst, limits.saturation);
    verdict.figure = worst;
    if (verdict.grade != Grade::Ok) {
        verdict.evidence = "saturated in every exposure: " + amount(worst.value, "1") +
                           " of the field under " + state;
        verdict.next =
            "the sample is brighter than the dimmest LED level allows: the lost cells "
            "are missing, trust no albedo of it";
    }
    return verdict;
}

}  // namespace gonio::proc
