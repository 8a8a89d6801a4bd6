#pragma once
// A value with its standard uncertainty (k = 1), split into what averages out over cells (random)
// and what does not (systematic), and its flags.

#include <cmath>
#include <limits>

#include "proc/core/flags.h"

namespace gonio {

template <class T>
struct Measured {
    T value{};
    double uRandom = 0;
    double uSystematic = 0;
    Flags flags{Flag::Measured};

    /// Combined standard uncertainty.
    [[nodiscard]] double u() const { return std::hypot(uRandom, uSystematic); }
    [[nodiscard]] bool present() const { return flags.has(Flag::Measured); }

    /// Nothing was measured here: value and uncertainties NaN, flag `measured` clear.
    [[nodiscard]] static Measured missing(Flags why = {}) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        return {T(nan), nan, nan, why.clear(Flag::Measured)};
    }
};

}  // namespace gonio
