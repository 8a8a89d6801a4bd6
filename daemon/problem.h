#pragma once
// Errors as words: how a daemon's answer and the logbook name the kind of an error, so that a
// client ends with the same exit code as if it had met the error itself.

#include <string_view>

#include "proc/core/result.h"

namespace gonio::daemon {

/// "internal", "usage", "no-rig", "busy", "device", "file", "quality", "interrupted".
[[nodiscard]] std::string_view problemName(ErrorKind kind);
/// Internal for a word that is none of them.
[[nodiscard]] ErrorKind problemKind(std::string_view name);

}  // namespace gonio::daemon
