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

/// A binned pixel is the mean of its members: shot, dark and read noise shrink, rounding does not.
double sampleVariance(double electrons, double seconds, const SensorNoise& noise, int members) {
    const double rounding = noise.electronsPerDn * noise.electronsPerDn / 12;
    return (noise.variance(electrons, seconds) - rounding) / members + rounding;
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
        const double single = sampleVariance(pooled * g.tau, g.seconds, noise, members);
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
                                   const SensorNoise& noise) {
    Result<std::vector<ExposureGroup>> groups = exposureGroups(bracket, band, darks);
    if (!groups) return groups.error();
    const Frame& first = bracket.front();
    const Size size = first.pixels.size();
    const double k = noise.electronsPerDn;
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
                Samples s{group.tau, group.seconds, group.dark->varianceOfMean * k * k, {}};
                for (const Frame* frame : group.frames) {
                    if (!usableReference(frame->pixels, x, y, noise)) continue;
                    const double dark = static_cast<double>(group.dark->mean.at(x, y));
                    s.electrons.push_back((frame->pixels.at(x, y) - dark) * k);
                }
                used += s.electrons.size();
                samples.push_back(s);
            }
            const int members = first.window.binning * first.window.binning;
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
