#pragma once
// What the sums of a bracket mean at a pixel: the dark, the non-linearity and the noise of each
// group, for whoever weighs its groups or its frames against each other.
//
// One sample of a group at a light of x electrons per second has the variance (electrons^2)
//     x tau / members + floor + excess,
// the mean of n of them that over n plus the dark frame's (1 + excess share). Shot, dark and read
// noise shrink in the mean of the members of a binned pixel, rounding does not.

#include <algorithm>
#include <cstddef>
#include <span>

#include "proc/core/image.h"
#include "proc/radiance/merge_accumulator.h"
#include "proc/radiance/merge_blocks.h"

namespace gonio::proc {

[[nodiscard]] GroupFigures figuresOf(const GroupSums& group, const BracketSums& sums);

/// Where a block of pixels begins. It ends with its row.
struct BlockAt {
    int x = 0, y = 0;

    /// The block's pixels of a picture.
    template <class T>
    [[nodiscard]] auto of(Image<T>& picture) const {
        return part(picture.row(y));
    }
    template <class T>
    [[nodiscard]] auto of(const Image<T>& picture) const {
        return part(picture.row(y));
    }

private:
    template <class T>
    [[nodiscard]] std::span<T> part(std::span<T> row) const {
        const auto begin = static_cast<std::size_t>(x);
        return row.subspan(begin, std::min(kBlock, row.size() - begin));
    }
};

/// Counts, linear sums less the dark, and excess variances of one group.
void readGroup(const BracketSums& sums, std::size_t group, const BlockAt& at, GroupBlock& out);

}  // namespace gonio::proc
