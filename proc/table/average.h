#pragma once
// The mean of a sample that was measured more than once, cell by cell (cell_mean.h): repeats of one
// rotation, or, where the sample is taken as isotropic, its rotations.
//
// What two captures share: the certificates, and, where they were calibrated alike, all else but
// the light of each capture and how the sample was seated. The light is one factor on all cells of
// a state. It is told apart from what differs from cell to cell: with m the mean of the captures,
//     k_i = sum(w f_i m) / sum(w m^2),   w = 1 / u_apart,i^2,
// is how much brighter capture i is than the mean, with u(k_i)^2 = 1 / sum(w m^2) + s^2 and s the
// part of one capture in the budget's `per state` components: 1 / sqrt(2) of it where the white is
// the same, all of it else. Cells that contradict each other though the median ratio of each
// capture to the first is divided out have no part in it; where more than a third of them do, no
// light is told apart. The cells are then held against k_i m.
// Both go into a chi-square of their own (that of the k_i is about their mean weighted by
// 1 / u(k_i)^2); what k_i is from 1 is held against
//     u(k_i - 1)^2 = (1 - W_i)^2 u(k_i)^2 + sum over j != i of W_j^2 u(k_j)^2,
// W_i the share of sum(w m^2) that is of capture i. f itself is averaged as it was measured, k_i
// included.
//
// A cell that is missing, or has no uncertainty, in some captures is the mean of the others; in
// all, it is missing. Without a budget all of u_systematic is taken as each capture's own, in its
// cells and as its light: chi-square is then too small.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "proc/table/consistency.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// How one capture's state compares with the mean of all.
struct StateScale {
    std::size_t capture = 0;
    Radians incidence;
    Band band = Band::R;
    double scale = 1;  ///< k_i
    double u = 0;      ///< k = 1
    /// From 1, in u(k_i - 1).
    double away = 0;
};

/// A cell of one capture that is further than kOutlier from the mean of all.
struct Outlier {
    std::size_t capture = 0;
    Radians incidence;
    Band band = Band::R;
    std::size_t cell = 0;
    double away = 0;      ///< signed, in standard uncertainties
    double relative = 0;  ///< f over the mean's, minus 1
};

struct Averaged {
    SampleSet set;  ///< at the first capture's rotation, with its information
    Consistency cells, scales;
    std::vector<StateScale> states;  ///< of each capture and state that others have, too
    std::vector<Outlier> outliers;   ///< the furthest first
    double weightSquares = 1;        ///< median over cells of sum w_i^2: what u_random^2 became
};

/// At least one capture; tables are matched by incidence, to half a degree.
[[nodiscard]] Averaged averageOf(std::span<const SampleSet> captures);

}  // namespace gonio::proc
