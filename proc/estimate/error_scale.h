#pragma once
// What an error of f is relative to: f itself, and where f is next to nothing a thousandth of what
// the sample reflects on average. Measured surfaces have cells of 0 and below; errors relative to
// such cells are thousands of per cent by any method, and would rule every sum that they enter.

#include <array>
#include <cmath>

#include "proc/fit/brdf_data.h"

namespace gonio::proc {

class ErrorScale {
public:
    static constexpr double kShareOfMean = 1e-3;
    /// 1/sr; what the rig cannot tell from nothing.
    static constexpr double kLeast = 1e-5;

    /// Nothing is known of what the sample reflects.
    ErrorScale() { floor_.fill(kLeast); }
    /// From the mean of f cos(theta_o) over each incidence, and of these over the incidences.
    explicit ErrorScale(const BrdfData& data);

    /// 1/sr.
    [[nodiscard]] double of(double f, std::size_t band) const {
        return std::hypot(f, floor_[band]);
    }

private:
    std::array<double, 3> floor_{};  ///< 1/sr, by band
};

}  // namespace gonio::proc
