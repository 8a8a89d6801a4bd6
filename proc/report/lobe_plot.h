#pragma once
// A lobe between the incidences that were measured: the truth and what methods make of it, f
// against signed theta_o in the plane of incidence, f on a logarithmic axis. The truth is drawn
// broad and grey below the others. A gap is a direction without an answer or without a positive
// one.

#include <string>
#include <vector>

#include "proc/estimate/interpolation_table.h"

namespace gonio::proc {

/// An SVG document; the first curve is the truth. No curve, or none with a value: a heading alone.
[[nodiscard]] std::string lobePlot(const std::string& title, const std::vector<LobeCurve>& curves);

}  // namespace gonio::proc
