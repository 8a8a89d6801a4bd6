#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/radiance/exposure_groups.h"
#include "proc/radiance/merge.h"
#include "proc/radiance/saturation.h"

namespace gonio::proc {
namespace {

/// The usable samples of one group at one pixel, in electrons.
struct Samples {
    double tau = 0;
    double seconds = 0;
    double darkVariance = 0;
    double excess = 0;  ///< electrons in the dark above a normal pixel's
    std::vector<double> electrons;

    [[nodiscard]] double mean() const {
        double sum = 0;
        for (double e : electrons) sum += e;
        return sum / static_cast<double>(electrons.size());
    }
};

struct Estimate {
    double radiance = std::numeric_limits<double>::quiet_NaN();
    double variance = std::numeric_limits<double>::quiet_NaN();
    double chiSquare = 0;
    std::size_t freedom = 0;
};

double sampleVariance(double electrons, double seconds, const SensorNoise& noise, int members) {
    return std::max(electrons, 0.0) / members + noise.darkVariance(seconds, members);
}

/// What the pixel reads in the dark above the others: 0 unless it is hot.
double excessDn(const DarkFrame& dark, int x, int y) {
    for (const HotPixel& hot : dark.hot) {
        if (hot.x == x && hot.y == y) return hot.excessDn;
    }
    return 0;
}

/// What one group saw at one pixel.
Samples samplesOf(const ExposureGroup& group,
                  int x,
                  int y,
                  const SensorNoise& noise,
                  const Linearity& linearity,
                  int members) {
    const double k = noise.electronsPerDn;
    const double hot = excessDn(*group.dark, x, y);
    Samples s{.tau = group.tau,
              .seconds = group.seconds,
              .darkVariance = group.dark->varianceOfMean * k * k +
                              hot * k / (members * std::max(1, group.dark->frames)),
              .excess = hot * k,
              .electrons = {}};
    for (const Frame* frame : group.frames) {
        if (!usableReference(frame->pixels, x, y, noise, hot)) continue;
        const double dark = linearity.corrected(static_cast<double>(group.dark->mean.at(x, y)));
        s.electrons.push_back((linearity.corrected(frame->pixels.at(x, y)) - dark) * k);
    }
    return s;
}

Estimate estimate(const std::vector<Samples>& groups, const SensorNoise& noise, int members) {
    double electrons = 0, tau = 0;
    for (const Samples& g : groups) {
        for (double e : g.electrons) {
            electrons += e;
            tau += g.tau;
        }
    }
    if (tau == 0) return {};
    const double pooled = electrons / tau;
    double sumW = 0, sumWx = 0;
    std::vector<std::pair<double, double>> weighted;
    for (const Samples& g : groups) {
        if (g.electrons.empty()) continue;
        const double single =
            sampleVariance(pooled * g.tau, g.seconds, noise, members) + g.excess / members;
        const double variance = single / static_cast<double>(g.electrons.size()) + g.darkVariance;
        const double weight = g.tau * g.tau / variance;
        weighted.emplace_back(weight, g.mean() / g.tau);
        sumW += weight;
        sumWx += weight * g.mean() / g.tau;
    }
    Estimate result{.radiance = sumWx / sumW, .variance = 1 / sumW, .freedom = weighted.size() - 1};
    for (const auto& [weight, value] : weighted)
        result.chiSquare += weight * (value - result.radiance) * (value - result.radiance);
    return result;
}

}  // namespace

Result<MergedState> mergeReference(std::span<const Frame> bracket,
                                   Band band,
                                   const DarkLibrary& darks,
                                   const SensorNoise& noise,
                                   const Linearity& linearity) {
    Result<std::vector<ExposureGroup>> groups = exposureGroups(bracket, band, darks);
    if (!groups) return groups.error();
    const Frame& first = bracket.front();
    const Size size = first.pixels.size();
    const int members = first.window.binning * first.window.binning;
    MergedState state;
    state.radiance = state.variance = Image<float>(size);
    state.used = state.saturated = Image<std::uint8_t>(size);
    state.window = first.window;
    state.led = *first.led;
    state.band = band;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            std::vector<Samples> samples;
            std::size_t used = 0;
            for (const ExposureGroup& group : *groups) {
                samples.push_back(samplesOf(group, x, y, noise, linearity, members));
                used += samples.back().electrons.size();
            }
            const Estimate e = estimate(samples, noise, members);
            state.radiance.at(x, y) = static_cast<float>(e.radiance);
            state.variance.at(x, y) = static_cast<float>(e.variance);
            state.used.at(x, y) = static_cast<std::uint8_t>(std::min<std::size_t>(used, 255));
            state.saturated.at(x, y) =
                static_cast<std::uint8_t>(std::min<std::size_t>(bracket.size() - used, 255));
            state.allSaturatedPixels += used == 0 ? 1 : 0;
            state.chiSquare += e.chiSquare;
            state.freedom += e.freedom;
        }
    }
    return state;
}

}  // namespace gonio::proc
