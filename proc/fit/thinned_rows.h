#pragma once
// Fewer rows of data, for fits that need not see all.

#include <cstdint>
#include <vector>

#include "proc/fit/brdf_data.h"

namespace gonio::proc {

/// Indices of rows of those `groups`, at most about `count`, ascending: of each group its share, a
/// quarter of it nearest to the mirror direction, where lobes are, the rest evenly. The values say
/// nothing in it: rows picked by their brightness would be picked by their noise. Deterministic.
[[nodiscard]] std::vector<std::uint32_t> thinnedRows(const BrdfData& data,
                                                     const std::vector<bool>& groups,
                                                     std::size_t count);

/// The data with these rows alone; all incidences stay, some without rows.
[[nodiscard]] BrdfData withRows(const BrdfData& data, const std::vector<std::uint32_t>& rows);

}  // namespace gonio::proc
