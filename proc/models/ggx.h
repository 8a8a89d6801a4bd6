#pragma once
// Microfacet reflection with the GGX (Trowbridge-Reitz) distribution of normals [Walter2007, eq.
// 33], anisotropic as [Heitz2014, eq. 84], Smith masking [Heitz2014], Schlick Fresnel
// [Schlick1994]:
//   f = D(h) V(wi, wo) F(wi.h), V = G2 / (4 mu_i mu_o).
// alpha in [1e-7, 1]; f0 in [0, 1]; f90 = 1. D comes from the unnormalised h = wi + wo by
// components, so that it keeps its digits down to the smallest alpha. Reciprocal. Single scattering
// only: a rough white metal loses energy (E = 1 - ln 2 = 0.307 at alpha 1, normal incidence).

#include "proc/models/analytic.h"

namespace gonio::proc {

struct GgxAlpha {
    double x = 0.1;
    double y = 0.1;
};

enum class Masking {
    HeightCorrelated,
    Separable
};

/// Distribution of normals, 1/sr, at the unnormalised half vector (z > 0).
[[nodiscard]] double ggxD(const Eigen::Vector3d& half, GgxAlpha alpha);
/// Smith's Lambda; 0 at the normal.
[[nodiscard]] double ggxLambda(const Direction& w, GgxAlpha alpha);
/// V = G2 / (4 mu_i mu_o), 1/sr; finite for mu > 0.
[[nodiscard]] double ggxV(const LightView& pair, GgxAlpha alpha, Masking masking);
/// f0 + (1 - f0)(1 - cosine)^5.
[[nodiscard]] LedBands schlick(LedBands f0, double cosine);

class Ggx : public AnalyticModel {
public:
    Ggx(GgxAlpha alpha, LedBands f0, Masking masking) : alpha_(alpha), f0_(f0), masking_(masking) {}

protected:
    [[nodiscard]] LedBands evaluate(const LightView& pair) const override;

private:
    GgxAlpha alpha_;
    LedBands f0_;
    Masking masking_;
};

}  // namespace gonio::proc
