#pragma once
// The trade of acquisition as a picture: relative uncertainty of the worst cell, in per cent and
// k = 1, against seconds on the rig, both logarithmic; a column of panels for each rig, a row for
// each material. One colour for each number of LED levels: the total solid with a mark for each
// plan, the random part dashed, the Cramer-Rao bound of the same shots dotted (its own seconds
// against the random part). A horizontal line is the systematic floor of the worst cell, a vertical
// one the published time of the MiniDiff V2.

#include <string>
#include <vector>

#include "proc/plan/trade_study.h"

namespace gonio::proc {

/// An SVG document of the rows, panels in the order of their first rows. Rows without a finite
/// uncertainty (no cell could be measured) are left out; without any row: a heading alone.
[[nodiscard]] std::string tradePlot(const std::vector<TradeRow>& rows);

}  // namespace gonio::proc
