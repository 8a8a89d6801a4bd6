#pragma once
// What an evaluation of a model costs on this computer.

#include <optional>
#include <string>

#include "proc/core/stopwatch.h"

namespace gonio::daemon {

/// Nanoseconds of one evaluation of a spec, in double at reference effort, over an array of pairs
/// all over the hemisphere: the median of five passes. Empty for a spec that is none.
[[nodiscard]] std::optional<double> evaluationNanoseconds(const std::string& spec,
                                                          const Clock& clock);

}  // namespace gonio::daemon
