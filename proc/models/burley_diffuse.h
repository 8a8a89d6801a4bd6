#pragma once
// Burley's retro-reflective diffuse factor, which Disney's, Frostbite's and the principled models
// share [Burley2012, sec. 5.3]:
//   (1 + (F90 - 1)(1 - mu_i)^5)(1 + (F90 - 1)(1 - mu_o)^5).

#include "proc/models/kernel.h"

namespace gonio::proc {

/// 1 - (1 - mu)^5, as a product: at grazing it is 5 mu, of which a difference keeps nothing.
template <class D>
[[nodiscard]] D facingWeight(const D& mu) {
    const D c = D(1) - mu;
    return mu * (D(1) + c * (D(1) + c * (D(1) + c * (D(1) + c))));
}

/// Written as F90 (1 - mu)^5 + 1 - (1 - mu)^5, without a difference.
template <class P, class D>
[[nodiscard]] P burleyFactor(const P& f90, const Pair<D>& pair) {
    const auto toward = [&](const D& mu) { return f90 * schlickWeight(mu) + facingWeight(mu); };
    return toward(pair.in.z) * toward(pair.out.z);
}

}  // namespace gonio::proc
