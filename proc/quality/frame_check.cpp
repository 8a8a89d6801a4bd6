#include "proc/quality/frame_check.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace gonio::proc {
namespace {

constexpr std::size_t kLeastPixels = 1000;
constexpr double kDarkest = 1e-4, kSure = 5;

constexpr double kHiddenDn = 0.5;  // read noise that rounding may hide
constexpr double kLeastShare = 0.6, kOffsetSeconds = 15e-6, kBlackDn = 0.5;
constexpr int kStride = 2, kLeastReflex = 12;
constexpr double kSurelyBelow = 0.7, kSurelyAbove = 1.3;  // of full scale

std::span<const std::uint16_t> pixelsOf(const Frame& frame) { return frame.pixels.pixels(); }

/// From here on the noise of a pixel is half a DN.
double leastNoisyDn(const Frame& frame, const SensorNoise& noise) {
    const double enough = std::pow(kHiddenDn * noise.electronsPerDn, 2);
    const double electrons = std::max(0.0, enough - std::pow(noise.readNoiseElectrons, 2));
    return electrons > 0 ? frame.blackLevel + electrons / noise.electronsPerDn : 0;
}

/// How many times the light of one picture another has, at least and at most.
struct Factor {
    double least = 0, nominal = 0, most = 0;
};

Factor factorOf(const Frame& frame, const Frame& before, Band band) {
    const double now = frame.exposure.seconds(), then = before.exposure.seconds();
    const auto ratio = [&](double late, double early) {
        return std::max(now + late, 0.0) / std::max(then + early, 1e-6);
    };
    const double levels =
        static_cast<double>(frame.levels[band]) / std::max<double>(1, before.levels[band]);
    return {.least = ratio(-kOffsetSeconds, kOffsetSeconds) * std::min(1.0, levels),
            .nominal = ratio(0, 0) * levels,
            .most = ratio(kOffsetSeconds, -kOffsetSeconds) * std::max(1.0, levels)};
}

/// What the pixels of two pictures say together, in DN above black.
struct Comparison {
    double seen = 0, foretold = 0, variance = 0, count = 0;
    int reflex = 0, dark = 0, bright = 0;
};

class Comparer {
public:
    Comparer(const Frame& frame, const Frame& before, Band band, const SensorNoise& noise)
        : factor_(factorOf(frame, before, band)),
          noise_(noise),
          range_(noise.fullScaleDn - frame.blackLevel),
          seconds_(frame.exposure.seconds()),
          black_(frame.blackLevel),
          blackBefore_(before.blackLevel) {}

    void add(std::uint16_t now, std::uint16_t then) {
        if (then >= noise_.saturationDn()) return;
        const double dim = then - blackBefore_;
        const double sure = kSure * std::sqrt(varianceDn(dim)) + kBlackDn;
        const bool saturated = now >= noise_.fullScaleDn;
        if ((dim + sure) * factor_.most < kSurelyBelow * range_) {
            all_.reflex += saturated ? 1 : 0;
            sum(now - black_, dim);
        } else if ((dim - sure) * factor_.least > kSurelyAbove * range_) {
            ++all_.bright;
            all_.dark += saturated || now >= noise_.saturationDn() ? 0 : 1;
        }
    }
    [[nodiscard]] const Factor& factor() const { return factor_; }
    [[nodiscard]] const Comparison& all() const { return all_; }

private:
    [[nodiscard]] double varianceDn(double dn) const {
        return noise_.variance(dn * noise_.electronsPerDn, seconds_) /
               (noise_.electronsPerDn * noise_.electronsPerDn);
    }
    void sum(double now, double then) {
        all_.seen += now;
        all_.foretold += then;
        all_.variance += varianceDn(now) + factor_.nominal * factor_.nominal * varianceDn(then);
        ++all_.count;
    }
    Factor factor_;
    SensorNoise noise_;
    double range_, seconds_, black_, blackBefore_;
    Comparison all_;
};

/// More than noise and a black level that is off make of it, one way or the other.
Agreement ofSums(const Comparison& all, const Factor& factor) {
    const double sure =
        kSure * std::sqrt(all.variance) + kBlackDn * all.count * (1 + factor.nominal);
    if (all.seen < kLeastShare * factor.least * all.foretold - sure) return Agreement::Darker;
    if (all.seen > factor.most / kLeastShare * all.foretold + sure) return Agreement::Brighter;
    return Agreement::Agrees;
}

}  // namespace

bool isRepeated(const Frame& frame, const Frame& before, const SensorNoise& noise) {
    const auto now = pixelsOf(frame), then = pixelsOf(before);
    if (!std::ranges::equal(now, then)) return false;
    const double least = leastNoisyDn(frame, noise);
    std::size_t telling = 0;
    bool varied = false;
    for (const std::uint16_t dn : now) {
        telling += dn >= least && dn < noise.fullScaleDn ? 1 : 0;
        varied = varied || dn != now.front();
    }
    return varied && telling >= kLeastPixels;
}

bool isBlank(const Frame& frame, const SensorNoise& noise) {
    const auto pixels = pixelsOf(frame);
    if (pixels.size() < kLeastPixels || pixels.front() >= noise.fullScaleDn) return false;
    if (noise.readNoiseElectrons < kHiddenDn * noise.electronsPerDn) return false;
    return std::ranges::all_of(pixels, [&](auto dn) { return dn == pixels.front(); });
}

Agreement agreement(const Frame& frame, const Frame& before, Band band, const SensorNoise& noise) {
    if (frame.window != before.window || frame.gainDb != before.gainDb) return Agreement::Agrees;
    Comparer comparer(frame, before, band, noise);
    const Size size = frame.pixels.size();
    const auto now = pixelsOf(frame), then = pixelsOf(before);
    for (int y = 0; y < size.height; y += kStride) {
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width);
        for (std::size_t x = 0; x < static_cast<std::size_t>(size.width); x += kStride)
            comparer.add(now[row + x], then[row + x]);
    }
    const Comparison& all = comparer.all();
    if (all.reflex >= kLeastReflex) return Agreement::Reflex;
    if (frame.levels != before.levels) return Agreement::Agrees;
    // Where nearly all should be saturated and is not, there is little to sum.
    if (all.bright >= kLeastReflex && 2 * all.dark > all.bright) return Agreement::Darker;
    return ofSums(all, comparer.factor());
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
