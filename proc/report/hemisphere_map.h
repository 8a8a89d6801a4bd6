#pragma once
// The reflected hemisphere as seen from above, one panel for each incidence (row) and band (column;
// one column of what is monochrome). Radius is theta_o (equal steps in angle), phi_o counts
// counter-clockwise from the right, where a ring marks the light; f is coloured on one logarithmic
// scale for all panels. No answer, and what is no finite number, is grey, never the colour of 0;
// values at or below 0 (noise of a dark sample) take the scale's darkest colour.

#include <string>

#include "proc/report/plot_request.h"

namespace gonio::proc {

/// An SVG document. Total: a scatterer that answers nowhere gives grey panels, and no incidence a
/// heading alone.
[[nodiscard]] std::string hemisphereMaps(const Scatterer& scatterer, const PlotRequest& request);

}  // namespace gonio::proc
