#pragma once
// The trade of look-ups as a picture: for each material worst relative error in per cent against
// nanoseconds an evaluation (left) and against KiB (right), all logarithmic. A mark for each
// resolution: a disc of float, a square of half, a triangle of double (the MERL layout), which a
// line joins by ascending bytes; on the left also, dashed and without marks, in arrays. Filled:
// on the front; a ring: its knee.

#include <string>
#include <vector>

#include "proc/estimate/lookup_study.h"

namespace gonio::proc {

/// An SVG document; materials in the order of their first rows. What has no finite number above 0
/// is left out; without rows: a heading alone.
[[nodiscard]] std::string lookupPlot(const std::vector<LookupRow>& rows);

}  // namespace gonio::proc
