#include "proc/radiance/dark.h"

#include <string>
#include <utility>
#include <vector>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

std::string microseconds(const Exposure& exposure) {
    return fixed(exposure.seconds() * 1e6, 2) + " us";
}

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "dark: " + what};
}

/// Empty message: the frame belongs with the first.
std::string misfit(const Frame& frame, const Frame& first) {
    if (frame.led && !frame.levels.dark())
        return "a frame was taken with LED " + std::to_string(*frame.led) + " lit";
    if (frame.exposure.granted != first.exposure.granted) {
        return "exposures differ: " + microseconds(first.exposure) + " and " +
               microseconds(frame.exposure);
    }
    if (frame.window != first.window || frame.pixels.size() != first.pixels.size())
        return "frames have different windows";
    if (frame.gainDb != first.gainDb) return "frames have different gains";
    return {};
}

/// Variance between the frames, averaged over all pixels, DN^2. At least two frames.
double pooledVariance(std::span<const Frame> frames, const Image<float>& mean) {
    double sum = 0;
    for (const Frame& frame : frames) {
        const auto pixels = frame.pixels.pixels();
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const double d = static_cast<double>(pixels[i]) - static_cast<double>(mean.pixels()[i]);
            sum += d * d;
        }
    }
    return sum /
           (static_cast<double>(frames.size() - 1) * static_cast<double>(mean.pixels().size()));
}

}  // namespace

Result<DarkFrame> averageDark(std::span<const Frame> frames, const SensorNoise& noise) {
    if (frames.empty() || frames.front().pixels.empty()) return refused("no frames to average");
    const Frame& first = frames.front();
    for (const Frame& frame : frames) {
        if (std::string why = misfit(frame, first); !why.empty()) return refused(why);
    }
    const double count = static_cast<double>(frames.size());
    std::vector<double> sum(first.pixels.pixels().size(), 0.0);
    for (const Frame& frame : frames) {
        const auto pixels = frame.pixels.pixels();
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += pixels[i];
    }
    DarkFrame dark{.mean = Image<float>(first.pixels.size()),
                   .exposure = first.exposure,
                   .window = first.window,
                   .gainDb = first.gainDb,
                   .frames = static_cast<int>(frames.size())};
    for (std::size_t i = 0; i < sum.size(); ++i)
        dark.mean.pixels()[i] = static_cast<float>(sum[i] / count);
    const double k = noise.electronsPerDn;
    const double single = frames.size() > 1 ? pooledVariance(frames, dark.mean)
                                            : noise.darkVariance(dark.exposure.seconds()) / (k * k);
    dark.varianceOfMean = single / count;
    return dark;
}

void DarkLibrary::add(DarkFrame dark) {
    const Nanoseconds key = dark.exposure.granted;
    byExposure_.insert_or_assign(key, std::move(dark));
}

Result<const DarkFrame*> DarkLibrary::find(const Frame& frame) const {
    const auto found = byExposure_.find(frame.exposure.granted);
    if (found == byExposure_.end()) {
        return refused("no dark frame of " + microseconds(frame.exposure) + " among " +
                       std::to_string(size()) + "; take dark frames at each exposure in use");
    }
    const DarkFrame& dark = found->second;
    if (dark.window != frame.window || dark.mean.size() != frame.pixels.size() ||
        dark.gainDb != frame.gainDb) {
        return refused("the dark frame of " + microseconds(frame.exposure) +
                       " was taken with another window or gain; take dark frames again");
    }
    return &dark;
}

}  // namespace gonio::proc
