#pragma once
// The distribution of normals that fits a BRDF's retro-reflection [Dupuy2018, sec. 4]: D is what
// the power iteration D <- r sigma(D) leaves, with r = f(w, w) cos(theta) and sigma(w) the area
// that D shows to w. It only has to lie near the truth: the values of a TensorTable are divided by
// it.
//
// Where retro-reflection has no answer (the light is in the way; beyond what was measured) the next
// answered theta of the same azimuth toward the normal stands for it, before the first the next
// one; without any r = cos(theta). D is nowhere below a thousandth of 1/pi, so that no values
// explode.

#include <cstddef>

#include "proc/core/scatterer.h"
#include "proc/table/warp2d.h"

namespace gonio::proc {

struct NormalGrid {
    std::size_t width = 128;  ///< nodes over the root of theta
    std::size_t height = 2;   ///< nodes over phi, both ends of the circle; 2: isotropic
};

struct FittedNormals {
    GridStack ndf, sigma;    ///< one slice each; integral of ndf cos(theta) 1
    std::size_t asked = 0;   ///< directions of retro-reflection
    std::size_t filled = 0;  ///< of these, without an answer
};

[[nodiscard]] FittedNormals fitNormals(const Scatterer& from, const NormalGrid& grid);

}  // namespace gonio::proc
