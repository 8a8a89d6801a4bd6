#pragma once
// What a fit found, as the document gonio/fit/1 and as Markdown.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "proc/fit/selection.h"

namespace gonio::daemon {

[[nodiscard]] nlohmann::ordered_json fitJson(const proc::Selection& selection,
                                             const proc::BrdfData& data);
[[nodiscard]] std::string fitMarkdown(const proc::Selection& selection);

}  // namespace gonio::daemon
