#pragma once
// A TensorTable made of anything that answers, so that renderers load it as a measured material:
// normals from retro-reflection (tensor_normals.h), for each direction of the light the visible
// normals, and values f cos(theta_o) 4 sigma / ndf at the warped nodes of the square, which are
// smooth however narrow the lobe.
//
// A node whose view is below the horizon holds 0. Where there is no answer (views and lights beyond
// what was measured) the value at the same place of the square stands for it, of the next answered
// theta_i below, else above; the ratio that a value is hardly changes from one to the next. Without
// any: 0. All are counted. Negative f becomes 0, counted.

#include <cstddef>
#include <vector>

#include "proc/core/scatterer.h"
#include "proc/export/tensor_normals.h"
#include "proc/table/tensor_table.h"

namespace gonio::proc {

struct TensorFitOptions {
    /// Of the light, ascending, below 90.
    std::vector<double> thetaInDeg{
        0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85, 89};
    /// One: isotropic. Else ascending from -180 to 180, both there, at least three.
    std::vector<double> phiInDeg{0};
    NormalGrid normals{};  ///< height 2 is raised to 65 where the light has several azimuths
    std::size_t vndfWidth = 128, vndfHeight = 64;
    std::size_t side = 64;  ///< nodes of the values' square
    bool spectral = false;  ///< channels are the bands' wavelengths, not R, G, B
};

struct FittedTensor {
    TensorTable table;
    std::size_t nodes = 0;         ///< with the view above the horizon
    std::size_t filled = 0;        ///< of these, without an answer
    std::size_t negative = 0;      ///< answered below 0 in a band
    std::size_t uncertain = 0;     ///< answered with an uncertainty, which the table cannot hold
    std::size_t extrapolated = 0;  ///< answered from beyond what was measured
    std::size_t retroFilled = 0;   ///< directions without an answer in retro-reflection
};

[[nodiscard]] FittedTensor fitTensor(const Scatterer& from, const TensorFitOptions& options = {});

}  // namespace gonio::proc
