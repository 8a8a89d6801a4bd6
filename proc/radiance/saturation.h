#pragma once
// Which samples of a frame carry information about the light. The mask is hard, and its verdict on
// a sample must not hang on the sample's own noise: "below 95 % of full scale" on the sample itself
// keeps the low half of the noise of a pixel whose mean lies there, which biases it by 0.8 sigma
// (0.8 % on a full well of 1e4 electrons) - more than the noise of a whole cell. So the neighbours
// decide, whose noise is independent:
//     usable = mean of the four neighbours < 95 % of full scale, and the sample < 98.5 % of it.
// The second limit catches a pixel that stands out of its surroundings; 3.5 sigma above the first,
// it cuts off less than 1e-3 of the noise of one that does not.
//
// A hot pixel stands above its surroundings by what it reads above them in the dark. Its own
// verdict adds that excess to the mean of its neighbours, so that it does not hang on its own noise
// either: one that is full in the dark is never usable.
//
// At the edge of the picture the neighbour inside counts twice; without any, the pixel itself.

#include <cstdint>
#include <span>

#include "proc/core/image.h"
#include "proc/radiance/noise.h"

namespace gonio::proc {

/// For each pixel of row y 1 where it is usable, else 0.
void markUsable(const Image<std::uint16_t>& picture,
                int y,
                const SensorNoise& noise,
                std::span<std::uint8_t> usable);

/// The slow, obvious twin: one pixel, which may be a hot one.
[[nodiscard]] bool usableReference(const Image<std::uint16_t>& picture,
                                   int x,
                                   int y,
                                   const SensorNoise& noise,
                                   double excessDn = 0);

}  // namespace gonio::proc
