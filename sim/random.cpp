#include "sim/random.h"

#include <algorithm>
#include <cmath>

namespace gonio::sim {
namespace {

constexpr double kInversionLimit = 10;

// A 64-bit finaliser: every input bit flips every output bit with probability near 1/2.
std::uint64_t scramble(std::uint64_t x) {
    x ^= x >> 32;
    x *= 0xE9846AF9B1A615DULL;
    x ^= x >> 32;
    x *= 0xE9846AF9B1A615DULL;
    x ^= x >> 28;
    return x;
}

double centralQuantile(double q) {
    const double r = q * q;
    return (((((-39.69683028665376 * r + 220.9460984245205) * r - 275.9285104469687) * r +
              138.3577518672690) *
                 r -
             30.66479806614716) *
                r +
            2.506628277459239) *
           q /
           (((((-54.47609879822406 * r + 161.5858368580409) * r - 155.6989798598866) * r +
              66.80131188771972) *
                 r -
             13.28068155288572) *
                r +
            1);
}

double tailQuantile(double p) {
    const double q = std::sqrt(-2 * std::log(p));
    return (((((-0.007784894002430293 * q - 0.3223964580411365) * q - 2.400758277161838) * q -
              2.549732539343734) *
                 q +
             4.374664141464968) *
                q +
            2.938163982698783) /
           ((((0.007784695709041462 * q + 0.3224671290700398) * q + 2.445134137142996) * q +
             3.754408661907416) *
                q +
            1);
}

/// The nearest whole number; x >= 0. (std::round is a call into the library.)
double wholeNumber(double x) {
    if (x >= 0x1p52) return x;  // all doubles are whole from here
    return static_cast<double>(static_cast<std::int64_t>(x + 0.5));
}

}  // namespace

std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
    return scramble(scramble(a + 0x9E3779B97F4A7C15ULL) + b * 0xD1342543DE82EF95ULL + 1);
}

double uniform(std::uint64_t key, std::uint64_t counter) {
    const std::uint64_t bits = scramble(key + counter * 0x9E3779B97F4A7C15ULL) >> 11;
    return (static_cast<double>(bits) + 0.5) * 0x1p-53;
}

double normalQuantile(double u) {
    constexpr double kTail = 0.02425;
    if (u < kTail) return tailQuantile(u);
    if (u > 1 - kTail) return -tailQuantile(1 - u);
    return centralQuantile(u - 0.5);
}

double gaussian(std::uint64_t key, std::uint64_t counter) {
    return normalQuantile(uniform(key, counter));
}

double poisson(double mean, double u) {
    if (u <= 1 - mean) return 0;  // at most exp(-mean): most pixels of a dark frame end here
    if (mean > kInversionLimit) {
        const double z = normalQuantile(u);
        const double root = std::sqrt(mean - 1.0 / 12);  // rounding adds the rest of the variance
        const double x = mean + root * z + (z * z - 1) / 6 - (z * z * z - z) / (72 * root);
        return wholeNumber(std::max(0.0, x));
    }
    double term = std::exp(-mean);
    double sum = term;
    double n = 0;
    while (u > sum && n < 400) {
        n += 1;
        term *= mean / n;
        sum += term;
    }
    return n;
}

}  // namespace gonio::sim
