#pragma once
// A SphericalTable made by asking a Scatterer at each node: the way from anything that answers to
// the formats that hold blocks of normal-relative directions. Channels R, G and B are the bands;
// every other channel is one band of the caller's choice. Transmission blocks are asked too. A node
// without an answer is NaN; one on the horizon holds the limit toward it.

#include <cstddef>

#include "proc/core/scatterer.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

struct FilledSpherical {
    SphericalTable table;
    std::size_t nodes = 0;         ///< of all blocks, on their own side of the horizon
    std::size_t unanswered = 0;    ///< of these, without an answer: NaN in the table
    std::size_t uncertain = 0;     ///< answered with an uncertainty, which the table cannot hold
    std::size_t extrapolated = 0;  ///< answered from beyond what was measured
};

/// On the blocks of `grid`, whose values are not looked at.
[[nodiscard]] FilledSpherical fillSpherical(const Scatterer& from,
                                            SphericalTable grid,
                                            Band otherChannels = Band::G);

}  // namespace gonio::proc
