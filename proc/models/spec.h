#pragma once
// Models by name: "lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04". Lobes are joined by '+', the
// parameters of a lobe follow it after commas; albedo, f0, kd, ks, base, eta and k take one value
// or r/g/b, the others one. A value in double quotes may hold '+' and ',', as file names do. The
// names, their parameters and domains: docs/models.md.

#include <memory>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/models/analytic.h"

namespace gonio::proc {

/// Usage errors name the lobe and the parameter and say what is allowed; File errors name the
/// table.
[[nodiscard]] Result<std::unique_ptr<const AnalyticModel>> makeModel(std::string_view spec,
                                                                     EvalPath path = {});
/// All names, in the order of docs/models.md.
[[nodiscard]] std::vector<std::string_view> modelNames();

}  // namespace gonio::proc
