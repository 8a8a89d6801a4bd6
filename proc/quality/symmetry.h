#pragma once
// What a sample's symmetries and repeats say of it, as verdicts, by the chi-square of
// proc/table/consistency.h: whether it looks alike on both sides of the plane of incidence
// (plane_symmetry.h), at each rotation, and when it was measured again (average.h). A sample may be
// brushed or woven: nothing of this is refused, but who takes it as isotropic is warned.
//
// A figure is the median relative difference, and crosses its limit only where chi-square per
// degree of freedom says that it is more than chance.

#include "proc/quality/limits.h"
#include "proc/table/average.h"

namespace gonio::proc {

/// `plane symmetry`: of the rotation whose sides differ most; not determined where no cell and its
/// image were measured.
[[nodiscard]] Verdict planeVerdict(const SampleSet& sample, const QualityLimits& limits = {});

/// `isotropy`: of the sample's rotations; not determined of a single one.
[[nodiscard]] Verdict isotropyVerdict(const SampleSet& sample, const QualityLimits& limits = {});
[[nodiscard]] Verdict isotropyVerdict(const Averaged& rotations, const QualityLimits& limits = {});

/// `repeats`: the share of values that are outliers, and whether any capture's light stands out.
[[nodiscard]] Verdict repeatsVerdict(const Averaged& repeats, const QualityLimits& limits = {});

}  // namespace gonio::proc
