#include "proc/quality/symmetry.h"

#include <cmath>

#include "proc/core/number_text.h"
#include "proc/table/merged_info.h"
#include "proc/table/plane_symmetry.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

std::string chiSquareText(const Consistency& found) {
    return "chi-square per degree " + fixed(found.perFreedom(), 2) + " of " +
           std::to_string(found.freedom);
}

/// Warned where the median is above the limit and chance does not explain it.
Verdict ofSymmetry(const std::string& name,
                   const Consistency& found,
                   double warned,
                   const QualityLimits& limits) {
    Verdict verdict{.name = name, .figure = {}, .evidence = {}, .next = {}};
    if (found.freedom == 0 || !std::isfinite(found.medianRelative)) return verdict;
    verdict.figure = Figure{.value = found.medianRelative, .u = {}, .unit = "1", .limit = warned};
    const bool chance = found.perFreedom() < limits.symmetryChiSquare;
    verdict.grade = found.medianRelative > warned && !chance ? Grade::Warned : Grade::Ok;
    return verdict;
}

}  // namespace

Verdict planeVerdict(const SampleSet& sample, const QualityLimits& limits) {
    const std::vector<Radians> rotations = rotationsOf(sample);
    Consistency found;
    if (rotations.size() == 1) found = planeConsistency(sample);
    for (std::size_t i = 0; rotations.size() > 1 && i < rotations.size(); ++i) {
        const Consistency one = planeConsistency(tablesAt(sample, rotations[i]));
        const bool worse = found.freedom == 0 || one.perFreedom() > found.perFreedom();
        if (one.freedom > 0 && worse) found = one;
    }
    Verdict verdict = ofSymmetry("plane symmetry", found, limits.planeSymmetry, limits);
    if (!verdict.figure) {
        verdict.evidence = "no cell was measured on both sides of the plane of incidence";
        return verdict;
    }
    verdict.evidence = "the two sides of the plane of incidence are " +
                       amount(found.medianRelative, "1") + " rms from their mean in the median, " +
                       chiSquareText(found);
    if (verdict.grade == Grade::Warned) {
        verdict.next =
            "see that it lies flat; brushed or woven, measure it at several rotations and merge "
            "them";
    }
    return verdict;
}

Verdict isotropyVerdict(const Averaged& rotations, const QualityLimits& limits) {
    const Consistency& found = rotations.cells;
    Verdict verdict = ofSymmetry("isotropy", found, limits.isotropy, limits);
    if (!verdict.figure) {
        verdict.evidence = "no two rotations measured the same cell";
        return verdict;
    }
    verdict.evidence = "rotations are " + amount(found.medianRelative, "1") +
                       " rms from their mean in the median, " + chiSquareText(found);
    if (verdict.grade == Grade::Warned) {
        verdict.evidence = "not isotropic: " + verdict.evidence;
        verdict.next = "keep its rotations apart: merge without --isotropic";
    }
    return verdict;
}

Verdict isotropyVerdict(const SampleSet& sample, const QualityLimits& limits) {
    const std::vector<Radians> all = rotationsOf(sample);
    if (all.size() < 2) {
        return {
            .name = "isotropy", .figure = {}, .evidence = "measured at one rotation", .next = {}};
    }
    std::vector<SampleSet> rotations;
    rotations.reserve(all.size());
    for (const Radians rotation : all) rotations.push_back(tablesAt(sample, rotation));
    return isotropyVerdict(averageOf(rotations), limits);
}

Verdict repeatsVerdict(const Averaged& repeats, const QualityLimits& limits) {
    Verdict verdict{.name = "repeats", .figure = {}, .evidence = {}, .next = {}};
    const Consistency& found = repeats.cells;
    if (found.freedom == 0) {
        verdict.evidence = "no cell was measured twice";
        return verdict;
    }
    const double share = static_cast<double>(found.outliers) / static_cast<double>(found.values);
    verdict.figure = Figure{.value = share, .u = {}, .unit = "1", .limit = limits.repeatOutliers};
    const bool light = repeats.scales.outliers > 0;
    verdict.grade = share > limits.repeatOutliers || light ? Grade::Warned : Grade::Ok;
    verdict.evidence = std::to_string(found.outliers) + " of " + std::to_string(found.values) +
                       " values are further than " + fixed(kOutlier, 0) + " u from their mean, " +
                       chiSquareText(found);
    if (light) {
        verdict.evidence +=
            "; the light of " + std::to_string(repeats.scales.outliers) + " states stands out";
    }
    if (verdict.grade == Grade::Warned) {
        verdict.next = "look at which capture they are of, and leave it out or measure again";
    }
    return verdict;
}

}  // namespace gonio::proc
