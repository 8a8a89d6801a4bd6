#pragma once
// Metadata as one text of lines, for formats that have a place for a text: each line of
// metadataLines() with a line end behind it.

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/table/metadata.h"

namespace gonio::proc {

[[nodiscard]] inline std::string metadataText(const Metadata& about) {
    std::string text;
    for (const std::string& line : metadataLines(about)) text += line + "\n";
    return text;
}

/// Lines that a text may have: a text of line ends alone would take 32 times its own memory.
inline constexpr std::size_t kMostMetadataLines = 65536;

/// The last line needs no end. Nothing for more than kMostMetadataLines.
[[nodiscard]] inline std::optional<Metadata> metadataOfText(std::string_view text) {
    if (static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) > kMostMetadataLines) {
        return std::nullopt;
    }
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return metadataOfLines(lines);
}

}  // namespace gonio::proc
