#pragma once
// What the LEDs' light is worth now. At a constant current it falls as the chip warms, in red
// (AlInGaP) most; the rig reports the current of each exposure and the temperature of the LED
// board. Of a band,
//     light = i (1 + k (T - T_0)),   i = I / (I_full L / 65535),
// k is fitted while an LED that was cold warms up on a steady sample, several times over:
//     S_j / i_j = a (1 + k (T_j - T_0)) + b t_j,   S_j the mean signal of frame j,
// by weighted least squares, linear in a, a k and b. b is what the LED wanders by meanwhile: each
// cycle begins cold again, so that time and temperature can be told apart. What temperature and
// current do not tell of is left: the first bracket, repeated at the end of a run, shows it
// (proc/quality/repeat.h).

#include <array>
#include <cstdint>
#include <span>

#include "proc/core/bands.h"
#include "proc/core/result.h"

namespace gonio::proc {

/// An LED, some time after it was lit.
struct WarmUpPoint {
    double signal = 0;   ///< any unit, mean over a picture
    double u = 0;        ///< standard uncertainty
    double current = 1;  ///< i
    double celsius = 0;  ///< T
    double time = 0;     ///< t, any unit
};

struct WarmUpFit {
    double perKelvin = 0, uPerKelvin = 0;  ///< k
    double celsius = 0;                    ///< T_0: the mean of the warm-up
    double chiSquare = 0;
    std::size_t freedom = 0;
};

/// Quality error with fewer than eight points, points without signal or uncertainty, or where the
/// temperature rose by less than 0.2 K, or with time alone, so that there is nothing to fit to.
[[nodiscard]] Result<WarmUpFit> fitWarmUp(std::span<const WarmUpPoint> points);

/// How an LED was driven in an exposure.
struct LedDrive {
    std::uint16_t level = 0;  ///< of 65535
    double milliamp = 0;      ///< measured; 0: not known
    double celsius = 0;       ///< of the LED board
};

struct LedMonitor {
    std::array<WarmUpFit, 3> bands{};      ///< by index(Band)
    std::array<double, 3> fullMilliamp{};  ///< measured at full level; 0: not known
    double milliampStep = 0.1;             ///< of the current meter

    /// I over that of its level. 1 where it is not known, or where the meter's step says less than
    /// the level itself: more than 0.05 % of the current, uniform.
    [[nodiscard]] double relativeCurrent(Band band, const LedDrive& drive) const;
    /// The light of a band relative to that at T_0 and the nominal current of its level.
    [[nodiscard]] double light(Band band, const LedDrive& drive) const;
};

}  // namespace gonio::proc
