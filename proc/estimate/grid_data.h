#pragma once
// Data on the cells of CellGrid asked from anything that answers at some incidences: a table of
// other nodes becomes what estimators are made from.

#include <vector>

#include "proc/core/scatterer.h"
#include "proc/fit/brdf_data.h"

namespace gonio::proc {

/// At each cell's centre, the light at phi = 0; what does not answer is left out. Uncertainties are
/// not known: assumed as DataOptions says.
[[nodiscard]] BrdfData gridDataOf(const Scatterer& from,
                                  const std::vector<Radians>& incidences,
                                  const DataOptions& options = {});

}  // namespace gonio::proc
