#pragma once
// What nearest neighbours cost over the number of samples, as a picture: on the left seconds to
// build a set and for one query, by the tree and by a walk over all; on the right bytes of the tree
// and of the samples. All axes are logarithmic, and each curve says as what power it grows.

#include <string>
#include <vector>

#include "proc/table/neighbour_study.h"

namespace gonio::proc {

/// An SVG document. A value of 0 (a clock too coarse) is left out; without rows: a heading alone.
[[nodiscard]] std::string neighbourPlot(const std::vector<NeighbourCost>& rows);

}  // namespace gonio::proc
