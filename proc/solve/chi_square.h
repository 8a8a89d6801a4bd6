#pragma once
// The chi-square distribution: the probability that a sum of `dof` squares of standard normal
// numbers exceeds x. 1 at x <= 0; falls to 0 as x grows; for many degrees of freedom too (1e6).

namespace gonio::proc {

/// dof > 0. Relative error 1e-12 where the value is above 1e-300 and dof at most 1e4, 1e-9 up to
/// dof 1e6.
[[nodiscard]] double chiSquareTail(double x, double dof);

}  // namespace gonio::proc
