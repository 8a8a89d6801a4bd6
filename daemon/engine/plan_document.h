#pragma once
// A plan, and what came of it, as JSON. Uncertainties are relative and k = 1, times in seconds on
// the rig.

#include <nlohmann/json_fwd.hpp>

#include "proc/plan/plan.h"

namespace gonio::daemon {

/// {"random": {"worst", "p95", "median"}, "systematic", "total", "cells"}.
[[nodiscard]] nlohmann::ordered_json toJson(const proc::Prediction& prediction);

/// What a plan promises, in short: {"seconds", "wanted", "frames", "notes"} and its prediction.
[[nodiscard]] nlohmann::ordered_json promiseOf(const proc::Plan& plan);

/// All of the plan: what schema gonio/plan/1 says besides its name.
[[nodiscard]] nlohmann::ordered_json toJson(const proc::Plan& plan);

}  // namespace gonio::daemon
