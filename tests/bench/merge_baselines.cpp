#include "tests/bench/merge_baselines.h"

#include <algorithm>
#include <cmath>

namespace gonio::bench {
namespace {

/// 0 at both ends of the range, 1 in the middle.
double hat(double dn, double range) { return std::max(0.0, 1 - std::abs(2 * dn / range - 1)); }

template <class Weight>
double linearMean(std::span<const Sample> samples, const Weight& weight) {
    double sum = 0, weights = 0;
    for (const Sample& s : samples) {
        const double w = weight(s);
        sum += w * s.dn / s.seconds;
        weights += w;
    }
    return weights > 0 ? sum / weights : 0;
}

double longest(std::span<const Sample> samples, double) {
    const auto best =
        std::max_element(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
            return a.seconds < b.seconds;
        });
    return best->dn / best->seconds;
}

double debevec(std::span<const Sample> samples, double range) {
    double sum = 0, weights = 0;
    for (const Sample& s : samples) {
        if (s.dn <= 0) continue;  // has no logarithm
        const double w = hat(s.dn, range);
        sum += w * std::log(s.dn / s.seconds);
        weights += w;
    }
    return weights > 0 ? std::exp(sum / weights) : 0;
}

double hatLinear(std::span<const Sample> samples, double range) {
    return linearMean(samples, [range](const Sample& s) { return hat(s.dn, range); });
}

double robertson(std::span<const Sample> samples, double range) {
    return linearMean(samples, [range](const Sample& s) {
        const double z = (s.dn - range / 2) / (range / 2);
        return std::exp(-4 * z * z) * s.seconds * s.seconds;
    });
}

double mitsunagaNayar(std::span<const Sample> samples, double) {
    return linearMean(samples, [](const Sample& s) { return std::max(s.dn, 0.0); });
}

double hanji(std::span<const Sample> samples, double) {
    double dn = 0, seconds = 0;
    for (const Sample& s : samples) {
        dn += s.dn;
        seconds += s.seconds;
    }
    return dn / seconds;
}

}  // namespace

const std::vector<Baseline>& baselines() {
    static const std::vector<Baseline> all{{"longest unsaturated", longest},
                                           {"Debevec weights, log mean", debevec},
                                           {"hat weights, linear mean", hatLinear},
                                           {"Robertson", robertson},
                                           {"Mitsunaga-Nayar", mitsunagaNayar},
                                           {"Hanji Poisson sum", hanji}};
    return all;
}

}  // namespace gonio::bench
