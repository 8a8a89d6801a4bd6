#pragma once
// Directions drawn for Monte Carlo integration over wo at a given wi, from a mixture of lobes, and
// the density with which the mixture draws a direction. A model gives the lobes that resemble it.
//   cosine        pdf = mu_o / pi
//   mirror power  pdf = (n + 1) / (2 pi) cos^n about the mirror direction
//   half power    theta_h by (n + 1) / (2 pi) cos^n(theta_h), pdf / (4 wi.h)
//   GGX           visible normals by spherical caps [DupuyBenyoub2023], pdf = G1(wi) D / (4 mu_i)
//   Beckmann, GTR1  all normals, pdf = D cos(theta_h) / (4 wi.h) [Walter2007, eqs. 28, 29]
//                 [Burley2012, app. B.2]
// A draw that falls below the horizon is empty: it counts, with the value 0.

#include <optional>
#include <variant>
#include <vector>

#include "proc/core/direction.h"
#include "proc/models/normal_distribution.h"

namespace gonio::proc {

struct CosineLobe {};
struct MirrorPowerLobe {
    double n;
};
struct HalfPowerLobe {
    double n;
};
struct GgxLobe {
    Alpha<double> alpha;
};
struct BeckmannLobe {
    Alpha<double> alpha;
};
struct Gtr1Lobe {
    double alpha;
};
using SampledLobe =
    std::variant<CosineLobe, MirrorPowerLobe, HalfPowerLobe, GgxLobe, BeckmannLobe, Gtr1Lobe>;

/// Weights of a mixture are relative: they need not sum to 1. One that is not positive draws
/// nothing.
struct WeightedLobe {
    double weight = 1;
    SampledLobe lobe = CosineLobe{};
};
using LobeMixture = std::vector<WeightedLobe>;

/// Independent and uniform in [0, 1).
struct Uniforms {
    double lobe;
    double u;
    double v;
};

/// wi above the horizon. Empty as well where no weight is positive.
[[nodiscard]] std::optional<Direction> drawDirection(const LobeMixture& mixture,
                                                     const Direction& wi,
                                                     const Uniforms& random);
/// 1/sr, of drawing pair.out at pair.in; 0 below the horizon and where no weight is positive. Its
/// integral is 1 less the share of draws that are empty.
[[nodiscard]] double drawDensity(const LobeMixture& mixture, const LightView& pair);

}  // namespace gonio::proc
