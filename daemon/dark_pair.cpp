#include "daemon/dark_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/finest_binning.h"

namespace gonio::daemon {
namespace {

constexpr Microseconds kExposure{1000};
constexpr double kOutlier = 5;                                    // sigma
constexpr std::uint64_t kOwnStep = (std::uint64_t{1} << 48) - 1;  // jobs count theirs from 1

}  // namespace

Result<driver::Capture> takeDarkPair(driver::Rig& rig) {
    const driver::RigInfo info = rig.identify();
    const auto shortest = std::max(kExposure, info.exposureMin);
    const Window whole{.size = info.sensor, .binning = finestBinning(info.limits)};
    if (auto done = rig.configure(whole); !done) return done.error();
    return rig.capture({.planStep = kOwnStep, .exposure = shortest, .frames = 2, .keepLit = false});
}

DarkNoise noiseOf(const driver::Capture& pair) {
    const auto first = pair[0].pixels.pixels();
    const auto second = pair[1].pixels.pixels();
    DarkNoise noise;
    double most = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < 2; ++pass) {
        double n = 0, sum = 0, level = 0, squares = 0;
        for (std::size_t i = 0; i < first.size(); ++i) {
            const double difference = static_cast<double>(first[i]) - second[i];
            if (std::abs(difference - noise.step) > most) continue;
            n += 1;
            sum += difference;
            squares += difference * difference;
            level += (static_cast<double>(first[i]) + second[i]) / 2;
        }
        const double mean = sum / n;
        const double spread = std::sqrt(std::max(squares / n - mean * mean, 0.0));
        noise = {.mean = level / n, .sigma = spread / std::sqrt(2.0), .step = mean};
        most = kOutlier * std::max(spread, 1.0);
    }
    return noise;
}

double expectedSigma(const proc::SensorNoise& noise, const Frame& frame) {
    const int members = frame.window.binning * frame.window.binning;
    return std::sqrt(noise.darkVariance(frame.exposure.seconds(), members)) / noise.electronsPerDn;
}

}  // namespace gonio::daemon
