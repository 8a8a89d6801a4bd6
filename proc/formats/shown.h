#pragma once
// Words of a file in an error: short, printable and on one line, whatever the file holds.

#include <cstddef>
#include <string>
#include <string_view>

namespace gonio::proc {

/// What is not printable ASCII becomes '?'.
[[nodiscard]] inline std::string printable(std::string_view text) {
    std::string out(text);
    for (char& c : out) {
        if (c < ' ' || c > '~') c = '?';
    }
    return out;
}

/// Printable, in quotes, at most 40 bytes of it.
[[nodiscard]] inline std::string shown(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    return "'" + printable(word.substr(0, kLongest)) + (word.size() > kLongest ? "..." : "") + "'";
}

}  // namespace gonio::proc
