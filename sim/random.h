#pragma once
// Random numbers as pure functions of a key and a counter: the same on every machine and for any
// number of threads. Nothing here has a state.

#include <cstdint>

namespace gonio::sim {

/// A well-mixed key made of what names a stream of numbers. Order matters.
[[nodiscard]] std::uint64_t mixed(std::uint64_t a, std::uint64_t b);

/// Uniform in (0, 1), 53 bits.
[[nodiscard]] double uniform(std::uint64_t key, std::uint64_t counter);

/// Standard normal deviate of a uniform u in (0, 1): the inverse of the distribution function,
/// relative error below 1.2e-9 [Acklam's rational form].
[[nodiscard]] double normalQuantile(double u);

/// Standard normal.
[[nodiscard]] double gaussian(std::uint64_t key, std::uint64_t counter);

/// Poisson with the given mean (>= 0) from one uniform u: by inversion up to a mean of 10, above by
/// rounding the third-order Cornish-Fisher expansion, its variance less the 1/12 that the rounding
/// adds (Sheppard's correction). Just above 10 no probability is wrong by more than 3e-4 and the
/// variance by no more than 1e-4 of itself; both shrink as the mean grows. At mean = 0: 0.
[[nodiscard]] double poisson(double mean, double u);

}  // namespace gonio::sim
