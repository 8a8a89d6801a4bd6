#pragma once
// A sensor whose reading is not quite proportional to the light, put right. M is the reading above
// the black level in DN, m = M / range; what the light makes is
//     L = M + range (a_1 m + a_2 m^2 + ... + a_d m^d),   0 <= m <= 1.
// a_1 is such that over the range the best line through zero of L against M has slope 1: the gain
// of the sensor stays what it was on average. At M = 0: L = M; below: L = (1 + a_1) M, as
// just above it. Above the range: the correction is that at its end. Without coefficients: the
// identity.
//
// Fitted to a sweep of exposures at constant light, M_j seen at the effective time tau_j:
//     M_j = r tau_j + o - sum_k range a_k m_j^k     (k = 2 .. d)
// is linear in the rate r, the offset o and the a_k; least squares with the points' own standard
// uncertainties. o takes up what an error of the black level or of all exposure times by the same
// amount would do.

#include <span>
#include <vector>

#include "proc/core/frame.h"
#include "proc/core/result.h"
#include "proc/radiance/dark.h"
#include "proc/radiance/noise.h"

namespace gonio::proc {

struct Linearity {
    double blackDn = 0;
    double rangeDn = 1;                ///< largest M that was seen in the sweep
    std::vector<double> coefficients;  ///< a_1 .. a_d; none: the identity

    [[nodiscard]] bool identity() const { return coefficients.empty(); }
    /// L - M of a reading in DN, black level included.
    [[nodiscard]] double correction(double dn) const;
    /// The reading in DN, black level included, that a proportional sensor would have given.
    [[nodiscard]] double corrected(double dn) const { return dn + correction(dn); }
};

/// One exposure of a sweep.
struct SweepPoint {
    double tau = 0;     ///< seconds at full level
    double meanDn = 0;  ///< above the dark
    double u = 0;       ///< DN, standard uncertainty of the mean
};

struct LinearityFit {
    Linearity linearity;
    double inlPercent =
        0;  ///< largest distance of the fitted response from its best line, of range
    double largestResidualDn = 0;
    double offsetDn = 0, uOffsetDn = 0;  ///< o
    double rate = 0;                     ///< r, DN per second
    double chiSquare = 0;
    std::size_t freedom = 0;
};

/// Of each exposure of a sweep, by exposure: the mean less the dark over the pixels that all frames
/// of the sweep can use. Quality error without frames, where one pixel in a hundred is saturated,
/// or where the pixels differ by more than 5 % rms: the mean of what is bent is not the bend of the
/// mean, and the brightest pixels would lie beyond the range.
[[nodiscard]] Result<std::vector<SweepPoint>> sweepPoints(std::span<const Frame> sweep,
                                                          Band band,
                                                          const DarkLibrary& darks,
                                                          const SensorNoise& noise);

/// `degree` is d, 2 to 6. Quality error with fewer than d + 2 points, points that are not numbers
/// or without uncertainty, or effective times that cannot tell the terms apart.
[[nodiscard]] Result<LinearityFit> fitLinearity(std::span<const SweepPoint> sweep,
                                                double blackDn,
                                                int degree = 3);

}  // namespace gonio::proc
