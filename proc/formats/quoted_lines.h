#pragma once
// Lines key="value", with \n, \\ and \" escaped in the value: the text of .mbsdf files.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::proc {

struct QuotedLine {
    std::string key, value;
    std::size_t bytes = 0;  ///< of the file, its line end included
};

/// The line at the beginning of `text`; nothing where it is none, or has another escape.
[[nodiscard]] std::optional<QuotedLine> quotedLine(std::string_view text);
/// Letters, digits, '_', '.' and '-'.
[[nodiscard]] bool isQuotedKey(std::string_view key);
void appendQuotedLine(std::string& text, const QuotedLine& line);

}  // namespace gonio::proc
