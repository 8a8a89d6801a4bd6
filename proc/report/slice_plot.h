#pragma once
// The slice through the plane of incidence, f against theta_o on a logarithmic axis, one panel per
// incidence. Negative theta_o is the light's own side (phi = 0), positive the mirror's (phi = 180
// degrees). A band of +- 2 u (combined) surrounds each curve where uncertainties are known; a gap
// is a direction without an answer.

#include <string>

#include "proc/report/hemisphere_map.h"

namespace gonio::proc {

/// An SVG document.
[[nodiscard]] std::string slicePlots(const Scatterer& scatterer, const PlotRequest& request);

}  // namespace gonio::proc
