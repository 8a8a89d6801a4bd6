#pragma once
// The dual number that fits differentiate with: a value and its derivatives by N parameters,
// carried through every operation exactly. The one place that includes Ceres' own.

#include <ceres/jet.h>

namespace gonio::proc {

template <int N>
using Dual = ceres::Jet<double, N>;

}  // namespace gonio::proc
