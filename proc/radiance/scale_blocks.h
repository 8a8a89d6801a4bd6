#pragma once
// The sums of scale_system.h over a block of pixels, in loops as those of merge_blocks.h.

#include <span>

#include "proc/radiance/merge_blocks.h"

namespace gonio::proc {

/// What one node saw: z and w.
struct NodeBlock {
    BlockOfPixels rate{}, weight{};
};

/// What all nodes of a system say together.
struct PooledBlock {
    BlockOfPixels light{};    ///< y; 0: the pixel says nothing
    BlockOfPixels inverse{};  ///< 1 / sum of weights
    BlockOfPixels mean{};     ///< zbar
};

/// The mean of each pixel's four neighbours; 0 where one of them is missing or not a number, and
/// where it is below 0. Rows begin one pixel to the left of the block's first.
void findLight(std::span<const float> above,
               std::span<const float> here,
               std::span<const float> below,
               BlockOfPixels& light);

/// A hot pixel says more of itself than of the light, which is set to 0 there.
void dropHot(const GroupBlock& group, BlockOfPixels& light);

/// What a DN is.
struct PixelFigures {
    double electronsPerDn = 1;
    double members = 1;  ///< sensor pixels that one pixel is the mean of
};
/// A group's samples as a node's, where the light is `light`.
[[nodiscard]] NodeBlock asNode(const GroupBlock& group,
                               const GroupFigures& figures,
                               const PixelFigures& pixel,
                               const BlockOfPixels& light);

[[nodiscard]] PooledBlock pooled(const BlockOfPixels& light,
                                 std::span<const NodeBlock* const> nodes);

/// b_i.
[[nodiscard]] double pullOf(const PooledBlock& block, const NodeBlock& node);
/// H_ij and G_ij.
struct PairSums {
    double h = 0, g = 0;
};
/// `same`: i = j.
[[nodiscard]] PairSums pairSums(const PooledBlock& block,
                                const NodeBlock& i,
                                const NodeBlock& j,
                                bool same);

}  // namespace gonio::proc
