#pragma once
// How much of the light a surface sends back, from anything that answers, with what the sum itself
// may be wrong by, what the answers are uncertain by, and what nobody answered:
//   directional-hemispherical  a(wi) = integral of f(wi, wo) cos(theta_o) dwo,
//   mean (bihemispherical)     (1 / pi) integral of a(wi) cos(theta_i) dwi.
// The first is what files call TIS; both are in [0, 1] for a passive surface.
//
// By the product of two Gauss-Kronrod rules over panels of LobePolar, which resolve a lobe of any
// width about the mirror direction; the panel with the largest error is halved across its worse
// axis until the errors of all sum up to less than the tolerance, or the evaluations are spent. A
// lobe elsewhere (retroreflection) that is narrower than a panel's nodes, about 5 degrees, can fall
// between them: give such a scatterer a smaller tolerance and look at the error bound.
//
// The error bound is the sum over panels of the differences of the coarser and the finer rule along
// both axes: where the rules resolve f far above the true error, at a jump (the edge of what is
// answered) of its size.
//
// Uncertainty: uRandom is independent between cells of one square degree, so that
//     u_random^2 = Omega_cell integral of (u_random(wo) cos(theta_o))^2 dwo
// falls with their number; uSystematic is common to all and adds linearly. Empty where some answer
// did not carry it. In the mean, incidences of a few LEDs share cells: both add linearly over them.
//
// Missing is never 0: directions without an answer, NaN among them, add nothing to the value, and
// `missing` says what share of the projected solid angle (pi in all) they hold. Negative f counts
// as it is. With no answer at all, and below the horizon, the value is NaN and `missing` is 1.

#include <array>
#include <cstddef>
#include <optional>

#include "proc/core/scatterer.h"

namespace gonio::proc {

struct BandAlbedo {
    double value = 0;                            ///< of what was answered
    double errorBound = 0;                       ///< of the quadrature, absolute
    std::optional<double> uRandom, uSystematic;  ///< k = 1
    double missing = 0;                          ///< in [0, 1]

    /// Combined standard uncertainty; empty where nothing is known of it.
    [[nodiscard]] std::optional<double> u() const;
};

struct Albedo {
    std::array<BandAlbedo, 3> bands;  ///< R, G, B
    std::size_t evaluations = 0;
    bool converged = false;  ///< the error bound of every band met the tolerance

    [[nodiscard]] const BandAlbedo& operator[](Band band) const { return bands[index(band)]; }
};

inline constexpr double kSquareDegree = (kPi / 180) * (kPi / 180);  ///< sr

struct AlbedoOptions {
    double tolerance = 1e-5;                 ///< absolute, of each band
    std::size_t mostEvaluations = 40000;     ///< of one incidence; the first pass takes 5400
    double independentCell = kSquareDegree;  ///< sr, within which u_random is one error
};

[[nodiscard]] Albedo directionalAlbedo(const Scatterer& of,
                                       const Direction& wi,
                                       const AlbedoOptions& options = {});

struct MeanAlbedoOptions {
    AlbedoOptions directional;
    double tolerance = 1e-4;
    std::size_t mostIncidences = 255;  ///< the first pass takes 15
    /// Evenly spread; one serves an isotropic surface. What the azimuths between them would change
    /// is not in the error bound.
    int azimuths = 1;
};

/// Over theta_i by a Gauss-Kronrod rule in cos(theta_i), halved where it errs most. The error bound
/// holds both integrals', and so does what has converged. Asks on all cores: `of` must stand that.
[[nodiscard]] Albedo meanAlbedo(const Scatterer& of, const MeanAlbedoOptions& options = {});

}  // namespace gonio::proc
