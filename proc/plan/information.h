#pragma once
// What frames tell about a pixel's light. n frames of effective time tau (= exposure x LED level),
// merged by inverse variance (proc/radiance/merge.h), give the Fisher information about a rate x in
// electrons per second at full level
//     I(n) = tau^2 / ((x tau + c) / n + v),   c = D t + s_r^2 + K^2 / 12,
// v the variance of the mean dark frame that all n share, in electrons^2. Informations of different
// shots add; a shot that the pixel saturates tells nothing. With v = 0 this is the Cramer-Rao bound
// (radiometry.md 3). At n = 0: 0. As n -> infinity: tau^2 / v. With zero light: that of the dark.

#include "proc/plan/rig_model.h"

namespace gonio::proc {

/// A kind of shot as pixels see it.
struct ShotOption {
    ShotKind kind;
    double tau = 0;           ///< seconds at full level
    double noise = 0;         ///< c, electrons^2
    double darkVariance = 0;  ///< v, electrons^2
    double reach = 0;         ///< electrons per second up to which a pixel is not saturated

    /// I(n) of one pixel, in (electrons/second)^-2; 0 beyond the reach.
    [[nodiscard]] double information(double rate, int frames) const {
        if (frames <= 0 || rate > reach) return 0;
        return tau * tau / (single(rate) / frames + darkVariance);
    }
    /// The same per frame, with a dark frame without noise.
    [[nodiscard]] double idealInformation(double rate) const {
        return rate > reach ? 0 : tau * tau / single(rate);
    }
    /// The fewest frames with which I(n) >= wanted; 0 where none can.
    [[nodiscard]] double framesFor(double rate, double wanted) const;

private:
    /// Variance of one frame, electrons^2.
    [[nodiscard]] double single(double rate) const { return (rate > 0 ? rate * tau : 0) + noise; }
};

/// `darkFrames`: that the mean dark frame is made of. A sensor whose dark current alone fills the
/// pixel in this time gives a reach of 0.
[[nodiscard]] ShotOption shotOption(const SensorModel& sensor,
                                    const ShotKind& kind,
                                    int darkFrames);

}  // namespace gonio::proc
