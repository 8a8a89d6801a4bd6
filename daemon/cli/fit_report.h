#pragma once
// What a fit found, as the document gonio/fit/1 and as Markdown.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "proc/fit/selection.h"

namespace gonio::daemon {

[[nodiscard]] nlohmann::ordered_json fitJson(const proc::Selection& selection,
                                             const proc::BrdfData& data);
[[nodiscard]] std::string fitMarkdown(const proc::Selection& selection);

/// Time of one evaluation of a spec on this computer, in double at reference effort, over an array
/// of pairs: the median of five. Empty for a spec that is none.
[[nodiscard]] std::optional<double> evaluationNanoseconds(const std::string& spec);

}  // namespace gonio::daemon
