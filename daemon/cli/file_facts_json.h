#pragma once
// What `info` says of any file of a BRDF: proc/quality/file_facts.h as a document.

#include <nlohmann/json_fwd.hpp>

#include "proc/quality/file_facts.h"

namespace gonio::daemon {

/// The object "values" of info's document.
[[nodiscard]] nlohmann::ordered_json toJson(const proc::FileFacts& facts);

/// For people: ranges and counts by channel, totals against what is stated, on stdout.
void printFacts(const proc::FileFacts& facts);

}  // namespace gonio::daemon
