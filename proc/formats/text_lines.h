#pragma once
// A text as lines with their numbers: LF, CR LF or a bare CR, as some instruments write it, ends
// one. A byte order mark at the beginning is skipped.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::proc {

/// Without blanks and tabs at both ends.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
    const auto space = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && space(text.front())) text.remove_prefix(1);
    while (!text.empty() && space(text.back())) text.remove_suffix(1);
    return text;
}

/// On one line of a file: what would end it is a blank, and blanks at its end, which would not come
/// back, are left out.
[[nodiscard]] inline std::string onOneLine(std::string_view text) {
    std::string line(text);
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    while (line.ends_with(' ') || line.ends_with('\t')) line.pop_back();
    return line;
}

/// Fields between `separator`, trimmed; `reuse` is room from the last line.
[[nodiscard]] inline std::vector<std::string_view> fieldsBetween(
    char separator, std::string_view line, std::vector<std::string_view> reuse = {}) {
    reuse.clear();
    for (std::size_t at = 0; at <= line.size();) {
        const std::size_t end = std::min(line.find(separator, at), line.size());
        reuse.push_back(trimmed(line.substr(at, end - at)));
        at = end + 1;
    }
    return reuse;
}

/// Words between blanks and tabs.
[[nodiscard]] inline std::vector<std::string_view> wordsIn(
    std::string_view line, std::vector<std::string_view> reuse = {}) {
    constexpr std::string_view kSpace = " \t";
    reuse.clear();
    for (std::size_t at = line.find_first_not_of(kSpace); at < line.size();) {
        const std::size_t end = std::min(line.find_first_of(kSpace, at), line.size());
        reuse.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(kSpace, end);
    }
    return reuse;
}

/// The comments of a file, as many as are kept: a million empty ones are no reason to ask for more
/// memory than the file has.
class CommentLines {
public:
    static constexpr std::size_t kMost = 10'000;

    /// False: one too many.
    bool add(std::string_view line) {
        if (lines_.size() == kMost) return false;
        lines_.emplace_back(line);
        return true;
    }
    [[nodiscard]] const std::vector<std::string>& all() const { return lines_; }

private:
    std::vector<std::string> lines_;
};

class TextLines {
public:
    explicit TextLines(std::string_view text) : text_(text) {
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    }

    /// Without its end; empty behind the last one. An end at the end of the text begins no line.
    std::optional<std::string_view> next() {
        if (at_ >= text_.size()) return std::nullopt;
        const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
        const std::string_view line = text_.substr(at_, end - at_);
        at_ = end + (text_.substr(end).starts_with("\r\n") ? 2 : 1);
        ++number_;
        return line;
    }
    /// Of the line that was read last, from 1; 0 before the first.
    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] std::size_t bytesLeft() const {
        return text_.size() - std::min(at_, text_.size());
    }

private:
    std::string_view text_;
    std::size_t at_ = 0;
    int number_ = 0;
};

}  // namespace gonio::proc
