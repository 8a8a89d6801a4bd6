#include "proc/quality/frame_check.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

namespace gonio::proc {
namespace {

constexpr std::size_t kLeastPixels = 1000;
constexpr double kDarkest = 1e-4, kSure = 5;

constexpr double kHiddenDn = 0.5;  // read noise that rounding may hide
constexpr double kLeastShare = 0.6, kOffsetSeconds = 15e-6;
constexpr double kShareOfLevel = 0.3;        // of a level's light, of what its current would give
constexpr int kBlock = 4, kLeastBlocks = 3;  // pixels of its side; blocks
constexpr double kSurelyDim = 0.7;           // of the light that full scale wants at least

std::span<const std::uint16_t> pixelsOf(const Frame& frame) { return frame.pixels.pixels(); }

/// From here on the noise of a pixel is half a DN.
double leastNoisyDn(const Frame& frame, const SensorNoise& noise) {
    const double enough = std::pow(kHiddenDn * noise.electronsPerDn, 2);
    const double electrons = std::max(0.0, enough - std::pow(noise.readNoiseElectrons, 2));
    return electrons > 0 ? frame.blackLevel + electrons / noise.electronsPerDn : 0;
}

double levelsOf(const Shown& frame, const Shown& before, Band band) {
    return static_cast<double>(frame.frame->levels[band]) /
           std::max<double>(1, before.frame->levels[band]);
}

/// How many times the light of one picture another has, at least and at most. Where light may come
/// with any level, it is not known how many times at most of a higher one, nor at least of a lower.
struct Factor {
    double least = 0, most = 0;
};

Factor factorOf(const Shown& frame, const Shown& before, Band band) {
    const double now = frame.frame->exposure.seconds(), then = before.frame->exposure.seconds();
    const auto ratio = [&](double late, double early) {
        if (now == then) return 1.0;  // whatever it adds, it adds to both
        return std::max(now + late, 0.0) / std::max(then + early, 1e-6);
    };
    Factor factor{.least = ratio(-kOffsetSeconds, kOffsetSeconds),
                  .most = ratio(kOffsetSeconds, -kOffsetSeconds)};
    const double levels = levelsOf(frame, before, band);
    const bool alone = frame.black.holdsLeaks && before.black.holdsLeaks;
    if (levels < 1) {
        factor.least *= alone ? levels * kShareOfLevel : 0;
        if (alone) factor.most *= std::min(1.0, levels / kShareOfLevel);
    } else if (levels > 1) {
        factor.most *= alone ? levels / kShareOfLevel : std::numeric_limits<double>::infinity();
        if (alone) factor.least *= std::max(1.0, levels * kShareOfLevel);
    }
    return factor;
}

/// The light of some blocks of two pictures, in DN above black, and what it is known to.
struct Light {
    double now = 0, then = 0, varianceNow = 0, varianceThen = 0, pixels = 0;
};

/// Adds up, block by block, what two pictures say together.
class Comparer {
public:
    Comparer(const Shown& frame, const Shown& before, Band band, const SensorNoise& noise)
        : frame_(frame), before_(before), noise_(noise), factor_(factorOf(frame, before, band)) {
        // A reflex shows at any level: by as much as the levels say, here.
        reflexFactor_ = (frame.frame->exposure.seconds() + kOffsetSeconds) /
                        std::max(before.frame->exposure.seconds() - kOffsetSeconds, 1e-6) *
                        std::max(1.0, levelsOf(frame, before, band));
    }

    /// The block whose first pixel this is.
    void add(int left, int top) {
        const Size size = frame_.frame->pixels.size();
        const int right = std::min(left + kBlock, size.width);
        const int bottom = std::min(top + kBlock, size.height);
        double now = 0, then = 0;
        int full = 0;
        std::uint16_t mostNow = 0, mostThen = 0;
        for (int y = top; y < bottom; ++y) {
            for (int x = left; x < right; ++x) {
                const std::uint16_t a = frame_.frame->pixels.at(x, y);
                const std::uint16_t b = before_.frame->pixels.at(x, y);
                now += a;
                then += b;
                full += a >= noise_.fullScaleDn ? 1 : 0;
                mostNow = std::max(mostNow, a);
                mostThen = std::max(mostThen, b);
            }
        }
        const double pixels = (right - left) * (bottom - top);
        const Light light{.now = now - pixels * frame_.black.dn,
                          .then = then - pixels * before_.black.dn,
                          .varianceNow = variance(now, pixels, frame_),
                          .varianceThen = variance(then, pixels, before_),
                          .pixels = pixels};
        const bool saturatedThen = mostThen >= noise_.saturationDn();
        if (!saturatedThen && 2 * full >= pixels && isTooDimFor(full, light)) ++reflex_;
        if (mostNow < noise_.saturationDn()) {
            put(light, unsaturatedNow_);
            darker_ += isDarker(light) ? 1 : 0;
        }
        if (!saturatedThen) {
            put(light, unsaturatedThen_);
            brighter_ += isBrighter(light) ? 1 : 0;
        }
    }
    [[nodiscard]] Agreement verdict() const {
        if (reflex_ >= kLeastBlocks) return Agreement::Reflex;
        if (darker_ >= kLeastBlocks || isDarker(unsaturatedNow_)) return Agreement::Darker;
        if (brighter_ >= kLeastBlocks || isBrighter(unsaturatedThen_)) return Agreement::Brighter;
        return Agreement::Agrees;
    }

private:
    /// Of a sum over so many pixels alike.
    [[nodiscard]] double variance(double sum, double pixels, const Shown& shown) const {
        const double electrons = (sum / pixels - shown.black.dn) * noise_.electronsPerDn;
        return pixels * noise_.variance(electrons, shown.frame->exposure.seconds()) /
               (noise_.electronsPerDn * noise_.electronsPerDn);
    }
    /// All of its pixels together surely foretell less light than so many of them show.
    [[nodiscard]] bool isTooDimFor(int full, const Light& block) const {
        const double dim =
            block.then + kSure * std::sqrt(block.varianceThen) + block.pixels * before_.black.u;
        const double range = noise_.fullScaleDn - frame_.black.dn;
        return dim * reflexFactor_ < kSurelyDim * range * full;
    }
    [[nodiscard]] bool isDarker(const Light& light) const {
        const double low = kLeastShare * factor_.least;
        return light.now < low * light.then - sure(light, low);
    }
    [[nodiscard]] bool isBrighter(const Light& light) const {
        const double high = factor_.most / kLeastShare;
        return std::isfinite(high) && light.now > high * light.then + sure(light, high);
    }
    static void put(const Light& block, Light& sum) {
        sum.now += block.now;
        sum.then += block.then;
        sum.varianceNow += block.varianceNow;
        sum.varianceThen += block.varianceThen;
        sum.pixels += block.pixels;
    }
    /// What noise and black levels that are off make of `now` less so many times `then`.
    [[nodiscard]] double sure(const Light& light, double factor) const {
        return kSure * std::sqrt(light.varianceNow + factor * factor * light.varianceThen) +
               light.pixels * (frame_.black.u + factor * before_.black.u);
    }

    Shown frame_, before_;
    SensorNoise noise_;
    Factor factor_;
    double reflexFactor_ = 0;
    int reflex_ = 0, darker_ = 0, brighter_ = 0;  // blocks
    Light unsaturatedNow_, unsaturatedThen_;
};

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

Agreement agreement(const Shown& frame, const Shown& before, Band band, const SensorNoise& noise) {
    if (frame.frame->window != before.frame->window || frame.frame->gainDb != before.frame->gainDb)
        return Agreement::Agrees;
    Comparer comparer(frame, before, band, noise);
    const Size size = frame.frame->pixels.size();
    for (int y = 0; y < size.height; y += kBlock)
        for (int x = 0; x < size.width; x += kBlock) comparer.add(x, y);
    return comparer.verdict();
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
