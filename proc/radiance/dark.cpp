#include "proc/radiance/dark.h"

#include <algorithm>
#include <cmath>
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

constexpr double kHotSigmas = 5;

Image<float> meanOf(std::span<const Frame> frames) {
    Image<float> mean(frames.front().pixels.size());
    std::vector<double> sum(mean.pixels().size(), 0.0);
    for (const Frame& frame : frames) {
        const auto pixels = frame.pixels.pixels();
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += pixels[i];
    }
    const double count = static_cast<double>(frames.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
        mean.pixels()[i] = static_cast<float>(sum[i] / count);
    }
    return mean;
}

/// Sum of the squared differences between the frames and their mean at one pixel.
double squaresAt(std::span<const Frame> frames, const Image<float>& mean, std::size_t pixel) {
    double sum = 0;
    for (const Frame& frame : frames) {
        const double d = static_cast<double>(frame.pixels.pixels()[pixel]) -
                         static_cast<double>(mean.pixels()[pixel]);
        sum += d * d;
    }
    return sum;
}

/// The same, over all pixels.
double squares(std::span<const Frame> frames, const Image<float>& mean) {
    double sum = 0;
    const auto means = mean.pixels();
    for (const Frame& frame : frames) {
        const auto pixels = frame.pixels.pixels();
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const double d = static_cast<double>(pixels[i]) - static_cast<double>(means[i]);
            sum += d * d;
        }
    }
    return sum;
}

std::vector<HotPixel> hotPixels(const Image<float>& mean, double varianceOfMean) {
    double average = 0;
    for (const float dn : mean.pixels()) average += static_cast<double>(dn);
    average /= static_cast<double>(mean.pixels().size());
    const auto border = static_cast<float>(average + kHotSigmas * std::sqrt(varianceOfMean));
    std::vector<HotPixel> hot;
    for (int y = 0; y < mean.height(); ++y) {
        const auto row = mean.row(y);
        for (std::size_t x = 0; x < row.size(); ++x) {
            if (row[x] <= border) continue;
            hot.push_back({static_cast<int>(x), y, static_cast<double>(row[x]) - average});
        }
    }
    return hot;
}

/// Variance between the frames, DN^2, averaged over the pixels; at least two frames.
struct Pool {
    double squares = 0;
    std::size_t pixels = 0;
    [[nodiscard]] double variance(std::size_t frames) const {
        return squares / (static_cast<double>(frames - 1) * static_cast<double>(pixels));
    }
};

}  // namespace

Result<DarkFrame> averageDark(std::span<const Frame> frames, const SensorNoise& noise) {
    if (frames.empty() || frames.front().pixels.empty()) return refused("no frames to average");
    const Frame& first = frames.front();
    for (const Frame& frame : frames) {
        if (std::string why = misfit(frame, first); !why.empty()) return refused(why);
    }
    DarkFrame dark{.mean = meanOf(frames),
                   .hot = {},
                   .exposure = first.exposure,
                   .window = first.window,
                   .gainDb = first.gainDb,
                   .frames = static_cast<int>(frames.size())};
    const double count = static_cast<double>(frames.size());
    if (frames.size() == 1) {
        const double k = noise.electronsPerDn;
        dark.varianceOfMean = noise.darkVariance(dark.exposure.seconds()) / (k * k);
        dark.hot = hotPixels(dark.mean, dark.varianceOfMean);
        return dark;
    }
    Pool pool{.squares = squares(frames, dark.mean), .pixels = dark.mean.pixels().size()};
    // Frames without any noise still have that of rounding.
    const double single = std::max(pool.variance(frames.size()), 1.0 / 12);
    dark.hot = hotPixels(dark.mean, single / count);
    const auto width = static_cast<std::size_t>(dark.mean.width());
    for (const HotPixel& hot : dark.hot) {
        const auto pixel =
            static_cast<std::size_t>(hot.y) * width + static_cast<std::size_t>(hot.x);
        pool.squares -= squaresAt(frames, dark.mean, pixel);
        --pool.pixels;
    }
    dark.varianceOfMean = pool.variance(frames.size()) / count;
    return dark;
}

std::span<const HotPixel> DarkFrame::hotInRow(int y) const {
    const auto before = [](const HotPixel& pixel, int row) { return pixel.y < row; };
    const auto behind = [](int row, const HotPixel& pixel) { return row < pixel.y; };
    const auto first = std::lower_bound(hot.begin(), hot.end(), y, before);
    return {first, std::upper_bound(first, hot.end(), y, behind)};
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
