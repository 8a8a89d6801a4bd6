#pragma once
// How much a user wants to pay: one value, passed down from the command line to the planner, the
// estimator, the evaluation path and the preview. Never a hidden constant.

#include <optional>
#include <string_view>

#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio {

enum class Effort {
    Draft,
    Standard,
    Reference
};

[[nodiscard]] std::string_view name(Effort effort);
/// "draft", "standard" or "reference"; anything else is a Usage error that lists them.
[[nodiscard]] Result<Effort> parseEffort(std::string_view text);

}  // namespace gonio
