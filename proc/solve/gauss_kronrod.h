#pragma once
// The pair of rules with which an integral and its error come from the same 15 values: Kronrod's 15
// nodes, exact to degree 22, among them the 7 of Gauss-Legendre, exact to degree 13 [Piessens1983].
// What the two sums differ by is the error of the coarser one, and for anything that the rules
// resolve far more than that of the finer.

#include <array>

namespace gonio::proc {

struct KronrodNode {
    double x = 0;        ///< in (0, 1)
    double kronrod = 0;  ///< weights of the finer rule, which sum to 1
    double gauss = 0;    ///< of the coarser, likewise; 0 at the nodes that it does not have
};

/// By ascending x.
[[nodiscard]] const std::array<KronrodNode, 15>& gaussKronrod();

}  // namespace gonio::proc
