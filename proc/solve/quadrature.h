#pragma once
// Nodes and weights on [0, 1] of the two rules that integrals here are done with.
//   Gauss-Legendre  exact for polynomials of degree 2 n - 1; for smooth integrands.
//   tanh-sinh       [TakahasiMori1974] for integrands smooth inside and singular at the ends: the
//                   error falls like exp(-c n / log n) whatever happens there.

#include <cstddef>
#include <vector>

namespace gonio::proc {

struct QuadratureNode {
    double x = 0;       ///< in (0, 1), exact near 0: as small as 2e-17
    double weight = 0;  ///< they sum to 1
};

/// n >= 1 nodes, by Newton's method on the Legendre polynomial.
[[nodiscard]] std::vector<QuadratureNode> gaussLegendre(std::size_t n);
/// 2 n + 1 nodes at steps of 3.2 / n in the double-exponential variable, n >= 1: 1e-15 of a smooth
/// integral from about n = 25, where an end is singular from about 40.
[[nodiscard]] std::vector<QuadratureNode> tanhSinh(std::size_t n);

}  // namespace gonio::proc
