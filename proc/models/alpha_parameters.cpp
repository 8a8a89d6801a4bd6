#include "proc/models/alpha_parameters.h"

#include <cmath>

namespace gonio::proc {

AlphaNumbers alphaOf(SpecParameters& p) {
    if (p.has("roughness")) {
        const double roughness = p.number("roughness", {std::sqrt(kAlphaRange.low), 1});
        return {roughness * roughness, roughness * roughness};
    }
    if (p.has("alpha_x") || p.has("alpha_y")) {
        const double x = p.number("alpha_x", kAlphaRange);
        return {x, p.number("alpha_y", kAlphaRange)};
    }
    const double alpha = p.number("alpha", kAlphaRange);
    return {alpha, alpha};
}

FresnelNumbers fresnelOf(SpecParameters& p) {
    FresnelNumbers numbers;
    const bool exact = p.choice("fresnel", {"schlick", "exact"}) == 1;
    if (!p.has("eta")) {
        numbers.f0 = p.bands("f0", kShare);
        if (!exact) return numbers;
        for (Band b : kBands) {
            const double f0 = numbers.f0[b];
            if (f0 >= 1) {
                // No dielectric reflects all: one of this index lacks 4e-9.
                numbers.eta[b] = 1e9;
            } else {
                numbers.eta[b] = etaOfF0(f0);
            }
        }
        numbers.form = FresnelForm::Dielectric;
        return numbers;
    }
    numbers.eta = p.bands("eta", kIndexRange);
    const bool conductor = p.has("k");
    if (conductor) numbers.k = p.bands("k", {0, kIndexRange.high});
    for (Band b : kBands) {
        const ComplexIndex<double> index{numbers.eta[b], numbers.k[b]};
        numbers.f0[b] = fresnelConductor(index, 1.0);
    }
    if (exact) numbers.form = conductor ? FresnelForm::Conductor : FresnelForm::Dielectric;
    return numbers;
}

}  // namespace gonio::proc
