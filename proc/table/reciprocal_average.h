#pragma once
// Helmholtz reciprocity of a sample: f(a -> b) = f(b -> a). Each two tables of the set, of LEDs a
// and b at rotations r and q (one LED at two rotations, too), saw each other's light: in the rig's
// frame of a, the light of b stands at (theta_b, r - q). At one rotation these are the lights' own
// side of the plane of incidence. No symmetry of the sample is asked for.
//
// f toward a light is bilinear between the cells around it, with the uncertainties of the cell that
// holds it. The two share the certificates' common part alone. The mean of all
// that reach a cell (cell_mean.h) moves the cell that holds the direction once, by as much as it
// moves f there, and is flagged `reciprocity`. Chi-square is over the pairs, each by itself.

#include "proc/table/consistency.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

struct Reciprocal {
    SampleSet set;
    Consistency consistency;
    std::size_t pairs = 0;  ///< of directions, of all bands, that were seen both ways
};

[[nodiscard]] Reciprocal reciprocalAverage(SampleSet set);

}  // namespace gonio::proc
