#pragma once
// Flags in the columns of a CSV: decimal masks, as the program writes them.

#include <string_view>
#include <vector>

#include "proc/core/flags.h"
#include "proc/core/result.h"
#include "proc/formats/points_csv.h"

namespace gonio::proc {

/// One per row. A File error that names the row for a column that is not there, an empty field and
/// a number that is no mask.
[[nodiscard]] Result<std::vector<Flags>> flagsOf(const Points& points, std::string_view column);

/// Saturated, blocked or below the horizon: there is no value.
[[nodiscard]] bool isLost(Flags flags);

}  // namespace gonio::proc
