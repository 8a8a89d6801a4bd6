#pragma once
// Other ways to merge a bracket, as they are published, on the same 12-bit samples: dark
// subtracted, linear sensor, one frame for each exposure. A sample at or above 95 % of full scale
// is left out by all of them; a pixel without any other is NaN. Light comes out in electrons per
// second.

#include <span>
#include <string>
#include <vector>

namespace gonio::bench {

/// One pixel's samples: DN above the black level, and exposure in seconds.
struct Sample {
    double dn = 0;
    double seconds = 0;
};

struct Baseline {
    std::string name;
    /// DN per second from the usable samples of one pixel, at least one; `range`: DN of full scale
    /// above black.
    double (*merge)(std::span<const Sample> samples, double range);
};

/// Longest unsaturated exposure; Debevec 1997 (hat weights, mean of logarithms); hat weights,
/// linear mean; Robertson 2003 (Gaussian weight times t^2); Mitsunaga and Nayar 1999 (weight ~
/// signal); Hanji 2020 (Poisson sum).
[[nodiscard]] const std::vector<Baseline>& baselines();

}  // namespace gonio::bench
