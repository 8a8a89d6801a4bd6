#pragma once
// What an error of f is relative to: f itself, and where f is next to nothing a thousandth of what
// the sample reflects on average. Measured surfaces have cells of 0 and below; errors relative to
// such cells are thousands of per cent by any method, and would rule every sum that they enter.
//
// An answer is dark where it is below a twentieth of that average: its error is an amount, in 1/sr,
// not a share of it.

#include <algorithm>
#include <array>
#include <cmath>

#include "proc/fit/brdf_data.h"

namespace gonio::proc {

class ErrorScale {
public:
    static constexpr double kShareOfMean = 1e-3;
    static constexpr double kDark = 0.05;  ///< of the mean
    /// 1/sr; what the rig cannot tell from nothing.
    static constexpr double kLeast = 1e-5;

    /// Of a mean f, the same for all bands, 1/sr.
    explicit ErrorScale(double mean = 0) { mean_.fill(mean); }
    /// From the mean of f cos(theta_o) over each incidence, and of these over the incidences.
    explicit ErrorScale(const BrdfData& data);

    /// 1/sr.
    [[nodiscard]] double of(double f, std::size_t band) const {
        return std::hypot(f, std::max(kLeast, kShareOfMean * mean_[band]));
    }
    [[nodiscard]] bool isDark(double f, std::size_t band) const {
        return std::abs(f) < darkest(band);
    }
    /// From 1 at 0 to 1/2 where answers are no longer dark, and on to 0.
    [[nodiscard]] double darkness(double f, std::size_t band) const {
        const double t = f / darkest(band);
        return 1 / (1 + t * t);
    }

private:
    [[nodiscard]] double darkest(std::size_t band) const {
        return std::max(kLeast, kDark * mean_[band]);
    }

    std::array<double, 3> mean_{};  ///< 1/sr, by band
};

}  // namespace gonio::proc
