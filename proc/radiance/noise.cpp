#include "proc/radiance/noise.h"

#include <cmath>
#include <numbers>

namespace gonio::proc {

double roundingErrorDn(double sigmaDn) {
    constexpr int kHarmonics = 100;  // without noise they hold 99.7 % of it
    double squares = 0;
    for (int k = 1; k <= kHarmonics; ++k) {
        const double turns = 2 * std::numbers::pi * k;
        squares += 2 * std::exp(-std::pow(turns * sigmaDn, 2)) / (turns * turns);
    }
    return std::sqrt(squares);
}

}  // namespace gonio::proc
