#pragma once
// What the daemon says, taken apart and shown. A daemon of another version may say other things
// than this program knows: that is an error, never a crash.

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "daemon/cli/commands.h"
#include "proc/core/result.h"

namespace gonio::daemon {

using Show = std::function<void(const nlohmann::ordered_json&)>;

/// Hands `use` the JSON object that `answer` is. Internal error when it is none, or when `use` did
/// not find in it what it wanted.
Result<void> understood(const std::string& answer, const Show& use);

/// Prints an answer: as it is with --json, by `show` otherwise, and not at all with --quiet.
Result<void> shown(const CommonOptions& common,
                   const Result<std::string>& answer,
                   const Show& show);

}  // namespace gonio::daemon
