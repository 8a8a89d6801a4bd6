#include "proc/models/powers.h"

namespace gonio::proc {

// With R and L the cosines at which cos^n is Q = 1/2 and G = 1/18, the cubic through (1, 1), (R,
// Q), (L, G) and (0, 0). Written as divided differences of p(c) / c, which is a parabola
//   1 - t (slope - a t),  t = 1 - c:
// the published quotients of like terms lose eight digits.
CubicCoefficients cubicCoefficients(double n) {
    const double tR = -std::expm1(std::log(0.5) / n);       // 1 - R
    const double tL = -std::expm1(std::log(1.0 / 18) / n);  // 1 - L
    const double slopeR = (1 - 0.5 / (1 - tR)) / tR;
    const double slopeL = (1 - 1.0 / 18 / (1 - tL)) / tL;
    const double a = (slopeR - slopeL) / (tL - tR);
    const double slope = slopeR + a * tR;
    constexpr double kNever = std::numeric_limits<double>::infinity();
    // First zero of the parabola (for small n only); least value of the cubic: the smaller root of
    // 3 a t^2 - 2 (slope + a) t + 1 + slope = 0.
    const double zero = slope * slope - 4 * a;
    const double tZero = zero > 0 && slope > 0 ? 2 / (slope + std::sqrt(zero)) : kNever;
    const double half = slope + a;
    const double turn = half * half - 3 * a * (1 + slope);
    const double tLeast = turn > 0 ? (1 + slope) / (half + std::sqrt(turn)) : kNever;
    const double tCut = std::min(tZero, tLeast);
    return {.a = a,
            .b = slope - 2 * a,
            .c = 1 - slope + a,
            .cut = std::max(0.0, 1 - tCut),
            .slope = slope,
            .tCut = tCut};
}

}  // namespace gonio::proc
