#pragma once
// What the sensor adds to the light: the figures that turn DN into electrons and electrons into a
// variance. A sample of e electrons taken over t seconds has the variance
//     e + D t + s_r^2 + K^2 / 12
// (shot noise, dark current's shot noise, read noise, rounding). A binned pixel is the mean of its
// members: all of it shrinks but the rounding. Full scale ends the range;
// saturation.h says which samples near it still tell of the light.

#include <algorithm>

namespace gonio::proc {

struct SensorNoise {
    double electronsPerDn = 2.6;          ///< K
    double readNoiseElectrons = 2.4;      ///< s_r
    double darkElectronsPerSecond = 3.0;  ///< D, at 25 degC
    double fullScaleDn = 4095;            ///< what a saturated pixel reads

    /// Where the surroundings of a sample reach this many DN (black level included) it is masked.
    [[nodiscard]] double saturationDn() const { return 0.95 * fullScaleDn; }
    /// A sample that reaches this many DN itself is masked.
    [[nodiscard]] double ceilingDn() const { return 0.985 * fullScaleDn; }

    /// Variance in electrons^2 of one pixel that collected `electrons` in `seconds`: never below
    /// that of a dark pixel, as the estimate of a dim light can be negative and its noise cannot.
    [[nodiscard]] double variance(double electrons, double seconds) const {
        return std::max(electrons, 0.0) + darkVariance(seconds);
    }
    /// Of a dark pixel that is the mean of `members` of the sensor's.
    [[nodiscard]] double darkVariance(double seconds, int members = 1) const {
        return analogueVariance(seconds) / members + electronsPerDn * electronsPerDn / 12;
    }
    /// Of a dark pixel before it is rounded.
    [[nodiscard]] double analogueVariance(double seconds) const {
        return darkElectronsPerSecond * seconds + readNoiseElectrons * readNoiseElectrons;
    }
};

/// Rms error, DN, that rounding to whole DN leaves in the mean of any number of samples of one
/// light, over all lights: `sigmaDn` is the noise of a sample before it is rounded. sqrt(1/12)
/// without noise, 0.08 at 0.23 DN, 1e-8 at the 0.92 DN of a sensor pixel. By the harmonics of the
/// saw-tooth error, each damped by the noise's characteristic function [Widrow1996].
[[nodiscard]] double roundingErrorDn(double sigmaDn);

}  // namespace gonio::proc
