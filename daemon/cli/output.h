#pragma once
// How the commands print: JSON for machines, indented, on stdout.

#include <nlohmann/json_fwd.hpp>

namespace gonio::daemon {

/// What is no UTF-8 is replaced.
void printJson(const nlohmann::ordered_json& json);

}  // namespace gonio::daemon
