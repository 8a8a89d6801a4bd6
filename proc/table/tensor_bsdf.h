#pragma once
// Evaluates a TensorTable at any pair, as its reference does: linear between the light's directions
// and bilinear on the square, in double. Negative values (of colours outside a gamut) answer 0. All
// answers are `interpolated`; beyond the last theta of the light `extrapolated`, with the last. At
// and below the horizon: no answer, flag below_horizon; so close above it that no f can be told
// from f cos (kMinCosForBrdf): no answer.
//
// A table of half the circle is the same turned by 180 degrees; of a quarter, mirrored at both
// axes.

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/band_channels.h"
#include "proc/table/tensor_table.h"

namespace gonio::proc {

class TensorBsdf : public Scatterer {
public:
    /// File error for sizes that do not fit together, axes that do not ascend, densities that are
    /// none; the error of bandChannels() where its channels are none of the bands.
    [[nodiscard]] static Result<TensorBsdf> over(TensorTable table);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return bands_.count; }

private:
    TensorBsdf(TensorTable table, Warp2d vndf, BandChannels bands)
        : table_(std::move(table)), vndf_(std::move(vndf)), bands_(bands) {}

    TensorTable table_;  ///< without its vndf
    Warp2d vndf_;
    BandChannels bands_;
};

/// What is wrong with a table's sizes and axes; empty when nothing is.
[[nodiscard]] std::string complaintOf(const TensorTable& table);

/// The slices of the light's direction.
[[nodiscard]] SliceBlend blendAt(const TensorTable& table, Radians theta, Radians phi);

}  // namespace gonio::proc
