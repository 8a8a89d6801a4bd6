#pragma once
// A text file as words with their lines, comments set aside: the ground of the readers of keyword
// formats. White space is any of tab, space and line ends; a line ends in LF, CR LF or a bare CR. A
// byte order mark at the beginning is skipped.

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proc/core/number_text.h"

namespace gonio::proc {

[[nodiscard]] inline std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

class Words {
public:
    explicit Words(std::string_view text) : text_(text) {
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    }

    /// The next word, without taking it; empty at the end.
    [[nodiscard]] std::string_view peek() {
        skipSpace();
        std::size_t end = at_;
        while (end < text_.size() && !isSpace(text_[end])) ++end;
        return text_.substr(at_, end - at_);
    }
    std::string_view take() {
        const std::string_view word = peek();
        at_ += word.size();
        return word;
    }
    /// Takes the next word where it is one finite number, in one pass; else takes nothing.
    std::optional<double> takeNumber() {
        skipSpace();
        const auto number = leadingDouble(text_.substr(at_));
        if (!number) return std::nullopt;
        const std::size_t end = at_ + number->length;
        if (end < text_.size() && !isSpace(text_[end])) return std::nullopt;
        at_ = end;
        return number->value;
    }
    [[nodiscard]] bool done() {
        skipSpace();
        return at_ == text_.size();
    }
    [[nodiscard]] int line() const { return line_; }
    [[nodiscard]] std::size_t bytesLeft() const { return text_.size() - at_; }
    [[nodiscard]] std::vector<std::string> takeComments() { return std::move(comments_); }
    /// More comments than any file that was made to be read: what follows is not kept.
    [[nodiscard]] bool tooManyComments() const { return comments_.size() > kMostComments; }
    static constexpr std::size_t kMostComments = 10'000;

private:
    static bool isSpace(char c) {
        return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
    }
    void skipSpace() {
        while (at_ < text_.size()) {
            if (text_[at_] == '#') {
                skipComment();
            } else if (isSpace(text_[at_])) {
                if (endsLine()) ++line_;
                ++at_;
            } else {
                return;
            }
        }
    }
    /// A line ends in LF, CR LF or, as some instruments write it, in a bare CR.
    [[nodiscard]] bool endsLine() const {
        if (text_[at_] == '\r') return at_ + 1 == text_.size() || text_[at_ + 1] != '\n';
        return text_[at_] == '\n';
    }
    void skipComment() {
        const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
        std::string_view comment = text_.substr(at_ + 1, end - at_ - 1);
        if (!comment.empty() && comment.front() == ' ') comment.remove_prefix(1);
        if (!tooManyComments()) comments_.emplace_back(comment);
        at_ = end;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
    std::vector<std::string> comments_;
};

}  // namespace gonio::proc
