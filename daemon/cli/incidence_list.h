#pragma once
// --incidences 0,20,40.

#include <string>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio::daemon {

/// Degrees from 0 to below 90, with commas; a Usage error names the one that is not.
[[nodiscard]] Result<std::vector<Radians>> incidenceList(const std::string& list);

}  // namespace gonio::daemon
