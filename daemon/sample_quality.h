#pragma once
// Everything that judges a measured sample: its verdicts (docs/quality.md, proc/quality), each in
// the sample's information, and whether they let it pass. How it lay is judged with the correction
// of its tilt (sample_pose.h).

#include <optional>

#include "daemon/measurement.h"
#include "proc/quality/translucency.h"
#include "proc/table/sample_set.h"

namespace gonio::daemon {

/// A sample says by which limits it was judged.
void noteLimits(const JudgingLimits& limits, proc::SampleInfo& info);

/// By its table alone: reciprocity, plane symmetry, isotropy, energy, saturation. What is worked
/// out again is judged again.
void judgeTable(proc::SampleSet& sample, const proc::QualityLimits& limits);

/// How it was captured: frames, light, ambient, softness, drift; by the limits of the rig profile.
void judgeCapture(proc::SampleSet& sample,
                  const Captured& captured,
                  const RigReferences& references);

/// On what it lay, if that was said, and the same sample as it was measured on the other backing.
struct BackingEvidence {
    std::optional<proc::Backing> backing;
    std::optional<proc::SampleSet> other;
    Radians rotation{};  ///< of what is measured
};
/// Usage error where `other` does not say that it lay on the other backing than `backing`, or has
/// another rotation.
[[nodiscard]] Result<void> checkOther(const BackingEvidence& evidence);
/// Translucency; the backing is kept in `info.extra`.
void judgeBacking(proc::SampleSet& sample,
                  const BackingEvidence& evidence,
                  const proc::QualityLimits& limits);

/// Quality error that names all that was refused and what to do about it, unless `force`; what is
/// let pass with a warning goes to the log.
[[nodiscard]] Result<void> accepted(const proc::SampleSet& sample, bool force);

}  // namespace gonio::daemon
