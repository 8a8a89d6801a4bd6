#pragma once
// The sums of scale_system.h over a block of pixels, in loops as those of merge_blocks.h.

#include <span>

#include "proc/radiance/merge_blocks.h"

namespace gonio::proc {

/// What one node saw: z and w.
struct NodeBlock {
    BlockOfPixels rate{}, weight{};
};

/// What the nodes of a system have in common.
struct SharedBlock {
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

/// A group's samples as a node's, where the light is `light`; a hot pixel's light is set to 0.
void asNode(const GroupBlock& group,
            const GroupFigures& figures,
            double electronsPerDn,
            double members,
            BlockOfPixels& light,
            NodeBlock& node);

[[nodiscard]] SharedBlock shared(const BlockOfPixels& light,
                                 std::span<const NodeBlock* const> nodes);

/// b_i.
[[nodiscard]] double pullOf(const SharedBlock& block, const NodeBlock& node);
/// H_ij, G_ij and sum y P_ij.
struct PairSums {
    double h = 0, g = 0, a = 0;
};
[[nodiscard]] PairSums pairSums(const SharedBlock& block, const NodeBlock& i, const NodeBlock& j);

}  // namespace gonio::proc
