#pragma once
// The relaxed cover: frames may be fractions, dark frames have no noise, and a frame costs its
// place in the stream alone. Its time is the least that the Cramer-Rao bound allows on a rig with
// these shots; its prices (what a unit of each need's information costs at least) bound what is
// left of a partial answer. It is the linear program
//     min sum n_g c_g,  sum n_g i_g(x_j) >= q_j,  n_g >= 0
// solved by its dual, max sum q_j y_j with sum i_g(x_j) y_j <= c_g, y >= 0, by the simplex method
// from y = 0. Any y on the way satisfies the constraints: the bound holds even if stopped early.

#include <vector>

#include "proc/plan/cover.h"

namespace gonio::proc {

struct CoverBound {
    double seconds = 0;          ///< infinite when a need cannot be met at all
    std::vector<double> prices;  ///< y: seconds per unit of information, of each need
};

/// What the shots have counts as met already.
[[nodiscard]] CoverBound coverBound(const CoverProblem& problem);

/// Information that `need` has from what was taken already.
[[nodiscard]] double informationAtHand(const CoverProblem& problem, const CoverNeed& need);

}  // namespace gonio::proc
