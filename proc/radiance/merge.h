#pragma once
// A bracket of frames of one state (one LED, one band) becomes one radiance picture: electrons per
// second at full LED level, with its variance. A sample of e electrons taken over t seconds at
// drive level L has the effective time tau = t L / 65535; dark and black level are subtracted
// first.
//
// Estimator [Granados2010], with weights from the pooled estimate: first x0 = sum e / sum tau over
// all samples that are not saturated, then the inverse-variance mean
//     x = sum w e / tau / sum w,   w = tau^2 / var,   var(x) = 1 / sum w,
// where var of the mean of the n samples of one (exposure, level) is variance(x0 tau, t) / n plus
// the variance of the dark frame. Weights from the noisy samples themselves would bias dim pixels.
// A hot pixel (dark.h) of e_h electrons in the dark above the others has e_h more variance in each
// sample and e_h / N more in the mean of N dark frames; a normal pixel's result does not change by
// there being hot ones.
//
// Saturation is a hard mask (saturation.h), never on a prediction from other exposures. Negative
// samples survive; nothing is clipped. A pixel saturated in every frame has radiance and variance
// NaN and used = 0. With zero light x is zero on average, of either sign. With one frame x = e /
// tau.
//
// A non-linear sensor (linearity.h) is put right on the mean of a group at each pixel instead of on
// each sample: for samples that differ by sigma the two are c'' sigma^2 / 2 apart, where c is the
// correction; 0.03 DN at full well with 0.3 % of non-linearity. The variance is that without it.

#include <span>

#include "proc/core/bands.h"
#include "proc/core/frame.h"
#include "proc/core/result.h"
#include "proc/radiance/dark.h"
#include "proc/radiance/linearity.h"
#include "proc/radiance/merge_accumulator.h"
#include "proc/radiance/noise.h"

namespace gonio::proc {

struct MergedState {
    Image<float> radiance;          ///< electrons per second at full level
    Image<float> variance;          ///< of it
    Image<std::uint8_t> used;       ///< samples that entered, at most 255
    Image<std::uint8_t> saturated;  ///< samples that were masked, at most 255
    Window window;
    int led = 0;
    Band band = Band::R;
    std::size_t allSaturatedPixels = 0;
    /// Sum over pixels of the squared, normalised differences between the (exposure, level) groups
    /// and their mean, and its degrees of freedom: their quotient is 1 where noise alone differs.
    /// An LED that flickers, a sample that moved or a wrong exposure raise it.
    double chiSquare = 0;
    std::size_t freedom = 0;
};

/// What was added up so far; Quality error when that is nothing.
[[nodiscard]] Result<MergedState> mergeSums(const BracketSums& sums);

/// A whole bracket at once. Quality error when it is empty, mixes states, windows or gains, is not
/// lit in `band`, has no dark frame, or more frames alike than fit the sums.
[[nodiscard]] Result<MergedState> merge(std::span<const Frame> bracket,
                                        Band band,
                                        const DarkLibrary& darks,
                                        const SensorNoise& noise,
                                        const Linearity& linearity = {});

/// The slow, obvious twin: pixel by pixel and sample by sample in double, each made linear alone.
[[nodiscard]] Result<MergedState> mergeReference(std::span<const Frame> bracket,
                                                 Band band,
                                                 const DarkLibrary& darks,
                                                 const SensorNoise& noise,
                                                 const Linearity& linearity = {});

}  // namespace gonio::proc
