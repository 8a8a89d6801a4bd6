#include "proc/quality/frame_check.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace gonio::proc {
namespace {

constexpr std::size_t kLeastPixels = 1000;
constexpr double kDarkest = 1e-4, kSure = 5;

std::span<const std::uint16_t> pixelsOf(const Frame& frame) { return frame.pixels.pixels(); }

}  // namespace

bool isRepeated(const Frame& frame, const Frame& before, const SensorNoise& noise) {
    const auto now = pixelsOf(frame), then = pixelsOf(before);
    if (!std::ranges::equal(now, then)) return false;
    std::size_t telling = 0;
    bool varied = false;
    for (const std::uint16_t dn : now) {
        telling += dn < noise.fullScaleDn ? 1 : 0;
        varied = varied || dn != now.front();
    }
    return varied && telling >= kLeastPixels;
}

bool showsNoLight(const Frame& lit,
                  const DarkFrame& dark,
                  double whiteElectrons,
                  const SensorNoise& noise) {
    const auto pixels = pixelsOf(lit);
    const auto means = dark.mean.pixels();
    assert(pixels.size() == means.size());
    if (pixels.empty()) return false;
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        sum += static_cast<double>(pixels[i]) - static_cast<double>(means[i]);
    }
    const auto count = static_cast<double>(pixels.size());
    const double electrons = noise.electronsPerDn * sum / count;
    const double darkVariance = dark.varianceOfMean * std::pow(noise.electronsPerDn, 2);
    const double seconds = lit.exposure.seconds();
    const double u = std::sqrt((noise.darkVariance(seconds) + darkVariance) / count);
    const double least = kDarkest * whiteElectrons;
    return least > kSure * u && electrons < kSure * u && electrons < least;
}

}  // namespace gonio::proc
