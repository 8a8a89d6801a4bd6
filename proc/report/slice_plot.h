#pragma once
// The slice through the plane of incidence, f against theta_o on a logarithmic axis, one panel per
// incidence and one curve per band (one of what is monochrome). Negative theta_o, on the left, is
// the light's own side (phi = 0; a dotted line marks the light), positive the mirror's (phi = 180
// degrees). A band of +- 2 u (combined) surrounds a curve where uncertainties are known. A gap is a
// direction without an answer, or one whose f is no finite number above 0. The axis spans at most
// eight decades; below them a curve runs along the bottom.

#include <string>

#include "proc/report/plot_request.h"

namespace gonio::proc {

/// An SVG document. Total: a scatterer that answers nowhere gives empty panels, and no incidence a
/// heading alone.
[[nodiscard]] std::string slicePlots(const Scatterer& scatterer, const PlotRequest& request);

}  // namespace gonio::proc
