#pragma once
// Directions drawn for a scatterer that has no formula to draw from, a baked table above all: one
// set of lobes (sampling.h), and for each of some incidences the weights with which their mixture
// resembles f cos(theta_o) most, tabulated evenly in cos(theta_i). At a given wi the nearest
// tabulated incidence serves, for the draw and for its density alike, so that f cos / pdf has no
// bias whatever the weights.
//
// The weights maximise the integral of f cos(theta_o) ln(pdf) by expectation and maximisation
// [Dempster1977] over the nodes of LobePolar: the mixture that is least surprised by light. Each
// lobe keeps a hundredth, so that no direction with light is forgotten. Where f is nowhere
// positive, the weights are even.

#include <vector>

#include "proc/core/scatterer.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

/// A cosine lobe and GGX lobes of 1/2, 1, 2 and 4 times the width whose D has fallen to one half at
/// this tan(theta_h), none wider than alpha 1.
[[nodiscard]] LobeMixture lobesAbout(double halfWidthTangent);

struct DrawnDirection {
    Direction wo;
    double density = 0;  ///< 1/sr, above 0
};

class LobeDraw {
public:
    /// The weights of `lobes` are not looked at.
    LobeDraw(const Scatterer& of, const LobeMixture& lobes, std::size_t incidences = 32);

    /// wi above the horizon. Empty where the draw fell below it: it counts, with the value 0.
    [[nodiscard]] std::optional<DrawnDirection> draw(const Direction& wi,
                                                     const Uniforms& random) const;
    /// 1/sr, of drawing pair.out at pair.in.
    [[nodiscard]] double density(const LightView& pair) const;

    [[nodiscard]] const LobeMixture& mixtureAt(const Direction& wi) const;

private:
    std::vector<LobeMixture> mixtures_;
};

/// Variance of f cos(theta_o) / pdf over its mean squared, of the mean of the bands, when wo is
/// drawn from this mixture: draws needed for a relative error e are it / e^2. By quadrature; NaN
/// where f has no positive mean.
[[nodiscard]] double relativeVariance(const Scatterer& of,
                                      const Direction& wi,
                                      const LobeMixture& mixture);

}  // namespace gonio::proc
