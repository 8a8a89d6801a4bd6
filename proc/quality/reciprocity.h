#pragma once
// f(a -> b) against f(b -> a) for each two LEDs a, b of a sample, in the plane of incidence: on the
// lights' own side, where this is Helmholtz reciprocity and nothing else, and mirrored on the other
// side, which asks that the sample look the same after half a turn. For an LED at the normal the
// two sides of its picture are compared with the normal of the other's.
//
// f at an LED's incidence is bilinear between cell centres (sample_lookup.h). With d the difference
// over the mean of a pair and u_d its standard uncertainty, from the u of both as if independent:
// chi^2 per pair is the mean of (d / u_d)^2, and the size is the median |d|. What is common to all
// cells, such as the white's own error, cancels in d, so that u_d is rather too large.

#include <optional>
#include <vector>

#include "proc/core/bands.h"
#include "proc/quality/limits.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// One pair of directions that was measured both ways, at one rotation.
struct ReciprocalPair {
    std::size_t led = 0, other = 0;  ///< among the LEDs of that rotation
    bool mirrored = false;           ///< on the side away from the lights
    Band band = Band::R;
    double difference = 0;  ///< (f(led -> other) - f(other -> led)) / their mean
    double u = 0;
};
/// Those where both are present and above five standard uncertainties of the noise.
[[nodiscard]] std::vector<ReciprocalPair> reciprocalPairs(const SampleSet& sample);

/// `reciprocity`: graded by the median difference where chi^2 does not explain it.
[[nodiscard]] Verdict reciprocityVerdict(const SampleSet& sample, const QualityLimits& limits = {});

}  // namespace gonio::proc
