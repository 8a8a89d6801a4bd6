#pragma once
// Propagation of distributions [GumMonteCarlo2008] through the measurement equation of one cell
// (two_point.h): where first order is wrong, or on request. Each draw takes every input from its
// distribution (Gaussian, as all that is known of each is its standard uncertainty) and works f out
// again: signals by their noise and by the light of their captures, the tiles by their
// certificates, and then f at a direction that is off by the lens map's angle, along the local
// shape of f.
//
// f itself stays what the equation gives for the best values. The mean of the draws is off on the
// other side of the truth wherever the equation is curved: f at a direction that is off by delta
// has the mean f + f'' u^2 / 2, and to shift it once more by that would double the bias. Instead
// the uncertainty takes it in: u is 1 / 1.96 of the half width of the interval about f that holds
// 95 % of the draws. For a linear equation that is the standard deviation; with heavy tails, as of
// a quotient by a contrast that is hardly there, it stays finite.

#include <cstdint>

#include "proc/calibrate/local_shape.h"

namespace gonio::proc {

/// What f of one cell is made of. Variances are of the noise; the rest are k = 1.
struct CellInputs {
    double sample = 0, white = 0, black = 0;  ///< signals
    double sampleVariance = 0, whiteVariance = 0, blackVariance = 0;
    double fWhite = 0, fBlack = 0;  ///< 1/sr
    double uWhite = 0;              ///< relative
    double uBlack = 0;              ///< 1/sr
    double uLight = 0;              ///< relative, of each capture
    DirectionSpread uAngle{};
    double uElse = 0;  ///< 1/sr: all that first order knows and this does not
    LocalShape shape;

    /// fb + (fw - fb) (S - S_b) / (S_w - S_b).
    [[nodiscard]] double f() const;
};

struct MonteCarlo {
    /// 0: only the cells where first order is wrong, kAutomaticDraws each.
    int draws = 0;
    std::uint64_t seed = 1;
};
inline constexpr int kAutomaticDraws = 2000;

/// k = 1, 1/sr.
struct PropagatedUncertainty {
    double random = 0;
    double systematic = 0;
};

/// At least 20 draws. The same seed gives the same result.
[[nodiscard]] PropagatedUncertainty propagate(const CellInputs& inputs,
                                              int draws,
                                              std::uint64_t seed);

/// First order is wrong: by a tenth of u for the curvature of f over the angle, or where the
/// contrast of white and black is not known to a tenth of itself.
[[nodiscard]] bool firstOrderFails(const CellInputs& inputs, double u);

}  // namespace gonio::proc
