#include "proc/models/alpha_parameters.h"

#include <cmath>

#include "proc/models/optical_constants.h"

namespace gonio::proc {

AlphaNumbers slopeAlphaOf(SpecParameters& p) {
    if (p.has("alpha_x") || p.has("alpha_y")) {
        if (p.has("alpha")) p.complain("alpha excludes alpha_x and alpha_y");
        const double x = p.number("alpha_x", kAlphaRange);
        return {x, p.number("alpha_y", kAlphaRange)};
    }
    const double alpha = p.number("alpha", kAlphaRange);
    return {alpha, alpha};
}

AlphaNumbers alphaOf(SpecParameters& p) {
    if (!p.has("roughness")) return slopeAlphaOf(p);
    for (const std::string other : {"alpha", "alpha_x", "alpha_y"}) {
        if (p.has(other)) p.complain("roughness excludes " + other);
    }
    const double roughness = p.number("roughness", {std::sqrt(kAlphaRange.low), 1});
    return {roughness * roughness, roughness * roughness};
}

namespace {

/// The dielectric of this f0; no dielectric reflects all, one of index 1e9 lacks 4e-9.
double indexOf(double f0) { return f0 < 1 ? etaOfF0(f0) : 1e9; }

/// From eta with or without k, or from a table of both.
void readIndex(SpecParameters& p, FresnelNumbers& numbers) {
    if (p.has("nk")) {
        const Result<OpticalConstants> table = readOpticalConstants(p.text("nk"));
        if (!table) return p.refuse(table.error());
        numbers.eta = table->eta;
        numbers.k = table->k;
        return;
    }
    numbers.eta = p.bands("eta", kIndexRange);
    if (p.has("k")) numbers.k = p.bands("k", {0, kIndexRange.high});
}

}  // namespace

FresnelNumbers fresnelOf(SpecParameters& p) {
    FresnelNumbers numbers;
    const bool exact = p.choice("fresnel", {"schlick", "exact"}) == 1;
    if (p.has("k") && !p.has("eta")) p.complain("k needs eta");
    if (p.has("eta") || p.has("nk")) {
        if (p.has("f0")) p.complain("f0 excludes eta and nk");
        const bool conductor = p.has("k") || p.has("nk");
        readIndex(p, numbers);
        for (Band b : kBands) {
            numbers.f0[b] =
                fresnelConductor(ComplexIndex<double>{numbers.eta[b], numbers.k[b]}, 1.0);
        }
        if (exact) numbers.form = conductor ? FresnelForm::Conductor : FresnelForm::Dielectric;
        return numbers;
    }
    numbers.f0 = p.bands("f0", kShare);
    for (Band b : kBands) numbers.eta[b] = indexOf(numbers.f0[b]);
    if (exact) numbers.form = FresnelForm::Dielectric;
    return numbers;
}

}  // namespace gonio::proc
