#pragma once
// The one door to the log. Messages go to stderr; data never does.

#include <string_view>

namespace gonio::log {

enum class Level {
    Debug,
    Info,
    Warning,
    Error
};

/// Messages below this level are dropped. Default: Warning.
void setLevel(Level level);

void debug(std::string_view message);
void info(std::string_view message);
void warning(std::string_view message);
void error(std::string_view message);

}  // namespace gonio::log
