#pragma once
// Veiling glare: of the light of each pixel, a share is spread over all pixels that see the field.
// Half of it goes to all alike, half is a halo about the pixel that falls as
//     1 / (1 + (r / 64 pixels)^2)          (64 pixels: nearly 10 degrees),
// scaled for each source so that the whole halo lands in the field. The field's light is the same
// with and without; the edge of the field stays sharp and the pixels outside it dark.

#include "sim/stage.h"

namespace gonio::sim {

inline constexpr double kHaloRadius = 64;  ///< pixels

/// The halo is worked out on a grid of 16 pixels, between whose nodes sources are split and the
/// sums interpolated: no pixel is off by more than 2 % of the halo's peak.
[[nodiscard]] RateImages withGlare(const RateImages& rates, const FieldOfView& field, double share);

/// The same for one image, pixel by pixel and source by source: for small fields.
[[nodiscard]] Image<float> withGlareReference(const Image<float>& rates,
                                              const FieldOfView& field,
                                              double share);

}  // namespace gonio::sim
