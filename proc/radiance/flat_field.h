#pragma once
// Photo-response non-uniformity: what each pixel answers to light of which its neighbours see as
// much. It cancels where sample and white fill a cell alike, and not on the flank of a lobe.
//
// Found in merged pictures of the white reference, which is smooth: a pixel's radiance over the
// mean of the 15 x 15 about it, the median over the pictures. A linear fall of the light leaves
// that mean alone; at 75 degrees, where the light falls fastest, what is bent is 1e-4. Where one of
// the 225 has no value, or they differ by more than 6 % (the edge of the field, a shadow of the
// optics), a picture says nothing of the pixel; where none does the response is 1.

#include <span>

#include "proc/core/image.h"
#include "proc/core/result.h"
#include "proc/radiance/merge.h"

namespace gonio::proc {

struct FlatField {
    Image<float> response;  ///< 1 on average
    Window window;
    double spread = 0;         ///< standard deviation of it, over the pixels that are known
    double uResponse = 0;      ///< of one pixel, median, k = 1: the pictures' own noise
    double coveredPixels = 0;  ///< share of the window's

    /// Radiance and variance as pixels that are all alike would have given them. The picture must
    /// have this window; any other is left as it is, and false is returned.
    [[nodiscard]] bool apply(MergedState& state) const;
    bool operator==(const FlatField&) const = default;
};

/// Quality error without pictures, when their windows differ, or when a fifth of the pixels is not
/// known.
[[nodiscard]] Result<FlatField> flatField(std::span<const MergedState* const> white);

}  // namespace gonio::proc
