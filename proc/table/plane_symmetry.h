#pragma once
// A sample that looks the same mirrored in the plane of incidence: each cell and its mirror image
// (phi -> -phi, another cell of the same row) are one quantity, measured twice. They share the
// light of their state and the certificates' common part, not the certificate of each direction,
// the angle's error or the seat's tilt.
//
// A cell that is its own image, and one whose image is missing, stays as it is.

#include "proc/table/consistency.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// In the same row: sector j of n is sector n - 1 - j.
[[nodiscard]] std::size_t mirroredCell(std::size_t cell);

struct Symmetrical {
    SampleSet set;
    Consistency consistency;
};

/// The set with both of each pair at their mean (cell_mean.h), and how well they agree.
[[nodiscard]] Symmetrical planeSymmetrical(SampleSet set);

/// The same, without making the set.
[[nodiscard]] Consistency planeConsistency(const SampleSet& set);

}  // namespace gonio::proc
