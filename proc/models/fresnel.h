#pragma once
// Fresnel reflectance of unpolarised light at a smooth boundary, as a function of the cosine of
// incidence c in [0, 1]; always in [0, 1].
//   dielectric  eta = n_t / n_i > 0; 1 at total reflection (eta < 1, c^2 <= 1 - eta^2).
//   conductor   index eta + i k against 1; k = 0 is the dielectric.
//   Schlick     f0 + (f90 - f0)(1 - c)^5 [Schlick1994].
// The usual forms subtract nearly equal numbers where eta is near 1 and k near 0; here every
// amplitude is a quotient whose numerator holds eta^2 - 1 as a product:
//   m = (eta - 1)(eta + 1), g = sqrt(m + c^2),
//   r_s = m / (g + c)^2, r_p = m (c^2 (eta^2 + 1) - 1) / (eta^2 c + g)^2, F = (r_s^2 + r_p^2) / 2,
// and for a conductor the same with complex eta and the square root whose larger part is computed
// first. Near the critical angle every form is ill-conditioned: F has an infinite slope there.

#include "proc/models/kernel.h"

namespace gonio::proc {

template <class P, class D>
[[nodiscard]] P schlick(const P& f0, const P& f90, const D& cosine) {
    return f0 + (f90 - f0) * schlickWeight(cosine);
}

/// The index against air of a dielectric of this f0 in [0, 1).
template <class P>
[[nodiscard]] P etaOfF0(const P& f0) {
    using std::sqrt;
    const P root = sqrt(f0);
    return (P(1) + root) / (P(1) - root);
}

template <class P, class D>
[[nodiscard]] P fresnelDielectric(const P& eta, const D& cosine) {
    using std::sqrt;
    const P tiny(std::numeric_limits<P>::min());
    const P m = (eta - P(1)) * (eta + P(1));
    const D c2 = cosine * cosine;
    const P g2 = m + c2;
    const P g = sqrt(g2 > tiny ? g2 : P(1));  // of no matter at total reflection
    const P eta2 = eta * eta;
    const P rs = m / squared(g + cosine);
    const P rp = m * (c2 * (eta2 + P(1)) - P(1)) / squared(eta2 * cosine + g);
    const P reflected = (rs * rs + rp * rp) * P(0.5);
    return g2 > P(0) && reflected < P(1) ? reflected : P(1);
}

template <class P>
struct ComplexIndex {
    P eta;
    P k;
};

template <class P, class D>
[[nodiscard]] P fresnelConductor(const ComplexIndex<P>& index, const D& cosine) {
    using std::sqrt;
    const P tiny(std::numeric_limits<P>::min());
    const P& eta = index.eta;
    const P& k = index.k;
    const D c2 = cosine * cosine;
    // m = N^2 - 1 and N^2, complex.
    const P mRe = (eta - P(1)) * (eta + P(1)) - k * k;
    const P im = P(2) * eta * k;
    const P nRe = (eta - k) * (eta + k);
    // w = sqrt(m + c^2).
    const P re = mRe + c2;
    const P size = sqrt(re * re + im * im + tiny);
    const P larger = sqrt((size + (re > P(0) ? re : -re)) * P(0.5) + tiny);
    const P smaller = im / (P(2) * larger);
    const P wRe = re > P(0) ? larger : smaller;
    const P wIm = re > P(0) ? smaller : larger;

    const P m2 = mRe * mRe + im * im;
    const P sNorm = P(1) / (squared(wRe + cosine) + wIm * wIm);
    const P rs = m2 * sNorm * sNorm;
    const P top = squared(c2 * (nRe + P(1)) - P(1)) + squared(c2 * im);
    const P pNorm = P(1) / (squared(nRe * cosine + wRe) + squared(im * cosine + wIm));
    const P rp = m2 * pNorm * top * pNorm;
    const P reflected = (rs + rp) * P(0.5);
    return reflected < P(1) ? reflected : P(1);
}

}  // namespace gonio::proc
