#include "proc/models/powers.h"

namespace gonio::proc {

// With R and L the cosines at which cos^n is Q = 1/2 and G = 1/18, the cubic through (1, 1), (R,
// Q), (L, G) and (0, 0). Written as divided differences of p(c) / c, which is a parabola: the
// published quotients of like terms lose eight digits.
CubicCoefficients cubicCoefficients(double n) {
    const double tR = -std::expm1(std::log(0.5) / n);       // 1 - R
    const double tL = -std::expm1(std::log(1.0 / 18) / n);  // 1 - L
    const double r = 1 - tR;
    const double l = 1 - tL;
    const double slopeR = (1 - 0.5 / r) / tR;
    const double slopeL = (1 - 1.0 / 18 / l) / tL;
    const double a = (slopeR - slopeL) / (tL - tR);
    // p(c)/c = 1 + (c - 1) slopeR + (c - 1)(c - R) a.
    const double b = slopeR - a * (1 + r);
    const double c = 1 - slopeR + a * r;
    // Least value: 3 a c^2 + 2 b c + C = 0, the larger root.
    const double root = b * b - 3 * a * c;
    const double cut = root > 0 ? (-b + std::sqrt(root)) / (3 * a) : 0;
    return {.a = a, .b = b, .c = c, .cut = std::max(0.0, cut)};
}

}  // namespace gonio::proc
