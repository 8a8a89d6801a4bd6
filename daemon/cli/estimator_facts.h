#pragma once
// What an estimator made of a surface, as `info --estimator` says it: the methods between and
// beyond the angles and how wrong each candidate was where it could be asked, the prior's gate, and
// the albedos that follow.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "daemon/estimators.h"

namespace gonio::daemon {

[[nodiscard]] nlohmann::ordered_json estimatorFacts(const Estimated& opened,
                                                    const std::string& name);

}  // namespace gonio::daemon
