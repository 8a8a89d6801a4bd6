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

/// Empty message: the frame belongs with those before.
std::string misfit(const Frame& frame, const DarkFrame& before, Size size) {
    if (frame.exposure.granted != before.exposure.granted) {
        return "exposures differ: " + microseconds(before.exposure) + " and " +
               microseconds(frame.exposure);
    }
    if (frame.window != before.window || frame.pixels.size() != size)
        return "frames have different windows";
    if (frame.gainDb != before.gainDb) return "frames have different gains";
    return {};
}

constexpr double kHotSigmas = 5;

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
    [[nodiscard]] double variance(int frames) const {
        return squares / ((frames - 1.0) * static_cast<double>(pixels));
    }
};

}  // namespace

Result<void> DarkAverage::add(const Frame& frame) {
    if (frame.pixels.empty()) return refused("a frame has no pixels");
    if (frame.led && !frame.levels.dark())
        return refused("a frame was taken with LED " + std::to_string(*frame.led) + " lit");
    if (about_.frames == 0) {
        about_.exposure = frame.exposure;
        about_.window = frame.window;
        about_.gainDb = frame.gainDb;
        sums_ = Image<std::uint32_t>(frame.pixels.size());
        squares_.assign(frame.pixels.pixels().size(), 0);
    } else if (std::string why = misfit(frame, about_, sums_.size()); !why.empty()) {
        return refused(why);
    }
    ++about_.frames;
    const auto pixels = frame.pixels.pixels();
    const auto sums = sums_.pixels();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const std::uint32_t dn = pixels[i];
        sums[i] += dn;
        squares_[i] += std::uint64_t{dn} * dn;
    }
    return {};
}

/// Sum of the squared differences between the frames and their mean at one pixel.
double DarkAverage::squares(std::size_t pixel) const {
    const double sum = sums_.pixels()[pixel];
    return static_cast<double>(squares_[pixel]) - sum * sum / about_.frames;
}

Result<DarkFrame> DarkAverage::mean() const {
    if (about_.frames == 0) return refused("no frames to average");
    DarkFrame dark = about_;
    const double count = dark.frames;
    dark.mean = Image<float>(sums_.size());
    const auto means = dark.mean.pixels();
    for (std::size_t i = 0; i < means.size(); ++i)
        means[i] = static_cast<float>(sums_.pixels()[i] / count);
    if (dark.frames == 1) {
        const double k = noise_.electronsPerDn;
        dark.varianceOfMean = noise_.darkVariance(dark.exposure.seconds()) / (k * k);
        dark.hot = hotPixels(dark.mean, dark.varianceOfMean);
        return dark;
    }
    Pool pool{.squares = 0, .pixels = means.size()};
    for (std::size_t i = 0; i < means.size(); ++i) pool.squares += squares(i);
    // Frames without any noise still have that of rounding.
    const double single = std::max(pool.variance(dark.frames), 1.0 / 12);
    dark.hot = hotPixels(dark.mean, single / count);
    const auto width = static_cast<std::size_t>(dark.mean.width());
    for (const HotPixel& hot : dark.hot) {
        pool.squares -=
            squares(static_cast<std::size_t>(hot.y) * width + static_cast<std::size_t>(hot.x));
        --pool.pixels;
    }
    dark.varianceOfMean = pool.variance(dark.frames) / count;
    return dark;
}

Result<DarkFrame> averageDark(std::span<const Frame> frames, const SensorNoise& noise) {
    DarkAverage average(noise);
    for (const Frame& frame : frames)
        if (Result<void> added = average.add(frame); !added) return added.error();
    return average.mean();
}

std::span<const HotPixel> DarkFrame::hotInRow(int y) const {
    const auto before = [](const HotPixel& pixel, int row) { return pixel.y < row; };
    const auto behind = [](int row, const HotPixel& pixel) { return row < pixel.y; };
    const auto first = std::lower_bound(hot.begin(), hot.end(), y, before);
    return {first, std::upper_bound(first, hot.end(), y, behind)};
}

DarkFrame pooled(const DarkFrame& one, const DarkFrame& other) {
    DarkFrame both = one.frames >= other.frames ? one : other;
    both.frames = one.frames + other.frames;
    const double share = static_cast<double>(one.frames) / both.frames, rest = 1 - share;
    both.varianceOfMean = share * share * one.varianceOfMean + rest * rest * other.varianceOfMean;
    const std::span<const float> a = one.mean.pixels(), b = other.mean.pixels();
    const std::span<float> mean = both.mean.pixels();
    for (std::size_t i = 0; i < mean.size(); ++i)
        mean[i] = static_cast<float>(share * a[i] + rest * b[i]);
    return both;
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
