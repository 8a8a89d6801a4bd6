#include "proc/solve/chi_square.h"

#include <algorithm>
#include <cmath>

#include "proc/core/units.h"

namespace gonio::proc {
namespace {

constexpr double kSmall = 1e-300;

/// x^a e^-x / Gamma(a). From a = 20 on by Stirling's series [Abramowitz1972, 6.1.37], x against a:
/// the logarithms of a^a and Gamma(a) are large and nearly cancel.
double front(double a, double x) {
    if (a < 20) return std::exp(a * std::log(x) - x - std::lgamma(a));
    const double off = (x - a) / a;
    const double i = 1 / (a * a);
    const double series = (1.0 / 12 - i * (1.0 / 360 - i * (1.0 / 1260 - i / 1680))) / a;
    return std::sqrt(a / (2 * kPi)) * std::exp(a * (std::log1p(off) - off) - series);
}

/// P(a, x) by the series of [Abramowitz1972, 6.5.29], for x < a + 1.
double lowerGamma(double a, double x) {
    double term = 1 / a;
    double sum = term;
    for (int k = 1; k < 100'000 && term > sum * 1e-16; ++k) {
        term *= x / (a + k);
        sum += term;
    }
    return sum * front(a, x);
}

/// Q(a, x) by the continued fraction of [Abramowitz1972, 6.5.31] (Lentz's evaluation), x >= a + 1.
double upperGamma(double a, double x) {
    double b = x + 1 - a;
    double c = 1 / kSmall;
    double d = 1 / b;
    double value = d;
    for (int k = 1; k < 100'000; ++k) {
        const double n = -k * (k - a);
        b += 2;
        d = n * d + b;
        if (std::abs(d) < kSmall) d = kSmall;
        c = b + n / c;
        if (std::abs(c) < kSmall) c = kSmall;
        d = 1 / d;
        value *= d * c;
        if (std::abs(d * c - 1) < 1e-15) break;
    }
    return value * front(a, x);
}

}  // namespace

double chiSquareTail(double x, double dof) {
    if (std::isnan(x)) return x;
    if (!(x > 0)) return 1;
    const double a = dof / 2;
    const double half = x / 2;
    const double tail = half < a + 1 ? 1 - lowerGamma(a, half) : upperGamma(a, half);
    return std::clamp(tail, 0.0, 1.0);
}

}  // namespace gonio::proc
