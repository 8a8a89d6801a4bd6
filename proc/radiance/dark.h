#pragma once
// What the sensor says without light. A DarkFrame is the mean of N dark frames of one exposure, in
// DN with the black level included, and the variance of that mean: read noise is alike all over a
// sensor, so the variance is pooled over its pixels; with a single frame it is the noise model's.
//
// Hot pixels are not alike. A pixel whose mean stands more than 5 standard deviations of the mean
// above the average of all is one: what it stands above them is dark current of its own, and has
// shot noise of its own. The pooled variance leaves them out. One normal pixel in a million is
// taken for hot by chance; a dark current whose noise is lost in the read noise stays unseen.
//
// A DarkLibrary holds one per granted exposure. Its match is exact: a dark frame of another
// exposure holds another amount of dark current, and is refused by name rather than scaled.

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "proc/core/frame.h"
#include "proc/core/result.h"
#include "proc/radiance/noise.h"

namespace gonio::proc {

struct HotPixel {
    int x = 0, y = 0;
    double excessDn = 0;  ///< of its mean above the average pixel's
};

struct DarkFrame {
    Image<float> mean;          ///< DN
    double varianceOfMean = 0;  ///< DN^2, of each pixel of `mean` that is not hot
    std::vector<HotPixel> hot;  ///< row by row, from left to right
    Exposure exposure;
    Window window;
    double gainDb = 0;
    int frames = 0;

    [[nodiscard]] std::span<const HotPixel> hotInRow(int y) const;
};

/// Dark frames of one exposure, added up as they come: a frame can be let go of once it was added.
/// Whole numbers, so that the sums are exact. 12 bytes a pixel.
class DarkAverage {
public:
    explicit DarkAverage(const SensorNoise& noise) : noise_(noise) {}

    /// Quality error, and nothing added, when it is lit, has no pixels, or differs from the first
    /// in exposure, window or gain.
    [[nodiscard]] Result<void> add(const Frame& frame);
    /// Of all that were added; Quality error when that is none.
    [[nodiscard]] Result<DarkFrame> mean() const;

private:
    [[nodiscard]] double squares(std::size_t pixel) const;

    SensorNoise noise_;
    DarkFrame about_;  // of the first, without its pixels
    Image<std::uint32_t> sums_;
    std::vector<std::uint64_t> squares_;
};

/// Quality error when there is none, when one is lit, or when they differ in exposure, window
/// or gain.
[[nodiscard]] Result<DarkFrame> averageDark(std::span<const Frame> frames,
                                            const SensorNoise& noise);

/// One mean of the frames of both, which are of the same exposure, window and gain. The hot pixels
/// are those of the one with more frames.
[[nodiscard]] DarkFrame pooled(const DarkFrame& one, const DarkFrame& other);

class DarkLibrary {
public:
    /// Replaces an earlier one of the same exposure.
    void add(DarkFrame dark);
    /// Quality error that names the exposure, when none fits this frame's exposure, window and
    /// gain. The pointer stays good until the library changes.
    [[nodiscard]] Result<const DarkFrame*> find(const Frame& frame) const;
    /// The one of the longest exposure, which shows most of what is not dark; null without any.
    [[nodiscard]] const DarkFrame* longest() const {
        return byExposure_.empty() ? nullptr : &byExposure_.rbegin()->second;
    }
    [[nodiscard]] std::size_t size() const { return byExposure_.size(); }

private:
    std::map<Nanoseconds, DarkFrame> byExposure_;
};

}  // namespace gonio::proc
