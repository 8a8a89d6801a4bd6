#include "proc/formats/quoted_lines.h"

#include <algorithm>

namespace gonio::proc {

std::optional<QuotedLine> quotedLine(std::string_view text) {
    constexpr std::size_t kLongestKey = 1024;
    const std::size_t equals = text.substr(0, kLongestKey).find('=');
    if (equals == std::string_view::npos || !isQuotedKey(text.substr(0, equals))) {
        return std::nullopt;
    }
    QuotedLine line{.key = std::string(text.substr(0, equals)), .value = {}};
    std::size_t at = equals + 1;
    if (at >= text.size() || text[at] != '"') return std::nullopt;
    for (++at; at < text.size() && text[at] != '"'; ++at) {
        if (text[at] == '\n') return std::nullopt;
        if (text[at] != '\\') {
            line.value += text[at];
            continue;
        }
        if (++at >= text.size()) return std::nullopt;
        if (text[at] != 'n' && text[at] != '\\' && text[at] != '"') return std::nullopt;
        line.value += text[at] == 'n' ? '\n' : text[at];
    }
    if (!text.substr(std::min(at, text.size())).starts_with("\"\n")) return std::nullopt;
    line.bytes = at + 2;
    return line;
}

bool isQuotedKey(std::string_view key) {
    constexpr std::string_view kLetters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
    return !key.empty() && key.find_first_not_of(kLetters) == std::string_view::npos &&
           !key.starts_with("MBSDF_DATA");
}

void appendQuotedLine(std::string& text, const QuotedLine& line) {
    text += line.key + "=\"";
    for (const char c : line.value) {
        if (c == '"' || c == '\\') text += '\\';
        if (c == '\n') {
            text += "\\n";
        } else {
            text += c;
        }
    }
    text += "\"\n";
}

}  // namespace gonio::proc
