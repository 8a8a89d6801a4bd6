#pragma once
// The reflected hemisphere as seen from above, one panel for each incidence (row) and band
// (column). Radius is theta_o (equal steps in angle), phi_o counts counter-clockwise from the
// right; f is coloured on one logarithmic scale for all panels. No answer is grey, never the colour
// of 0; values at or below 0 (noise of a dark sample) take the scale's darkest colour.

#include <string>
#include <vector>

#include "proc/core/scatterer.h"

namespace gonio::proc {

struct PlotRequest {
    std::string title;
    std::vector<Radians> incidences;  ///< light at phi = 0
};

/// An SVG document. Total: a scatterer that answers nowhere gives grey panels.
[[nodiscard]] std::string hemisphereMaps(const Scatterer& scatterer, const PlotRequest& request);

}  // namespace gonio::proc
