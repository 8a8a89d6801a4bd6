#pragma once
// Any text as XML and HTML may hold it, between tags and between double quotes.

#include <cstddef>
#include <string>
#include <string_view>

namespace gonio::proc {

/// Escaped; what no XML may hold (control characters, bytes that are no UTF-8) becomes '?'.
[[nodiscard]] std::string markupText(std::string_view words);
/// At most `most` letters, the last three of them dots where there are more.
[[nodiscard]] std::string shortenedText(std::string_view words, std::size_t most);

}  // namespace gonio::proc
