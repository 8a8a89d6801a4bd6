#include "proc/formats/json_scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

bool isSpace(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

void appendUtf8(std::string& text, std::uint32_t code) {
    const auto byte = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
    if (code < 0x80) {
        byte(code);
    } else if (code < 0x800) {
        byte(0xC0 | (code >> 6));
        byte(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
        byte(0xE0 | (code >> 12));
        byte(0x80 | ((code >> 6) & 0x3F));
        byte(0x80 | (code & 0x3F));
    } else {
        byte(0xF0 | (code >> 18));
        byte(0x80 | ((code >> 12) & 0x3F));
        byte(0x80 | ((code >> 6) & 0x3F));
        byte(0x80 | (code & 0x3F));
    }
}

/// The four hexadecimal digits at the beginning; empty where there are none.
std::optional<std::uint32_t> hexAt(std::string_view text) {
    std::uint32_t code = 0;
    if (text.size() < 4) return std::nullopt;
    const auto [end, error] = std::from_chars(text.data(), text.data() + 4, code, 16);
    if (error != std::errc{} || end != text.data() + 4) return std::nullopt;
    return code;
}

/// What \u stands for, with the second half of a pair; `used` bytes of `digits` belong to it.
std::uint32_t codeOf(std::string_view digits, std::size_t& used) {
    constexpr std::uint32_t kReplacement = 0xFFFD;
    const std::uint32_t code = hexAt(digits).value_or(kReplacement);
    used = 4;
    if (code < 0xD800 || code > 0xDFFF) return code;
    const std::string_view rest = digits.substr(std::min<std::size_t>(4, digits.size()));
    const auto low = rest.starts_with("\\u") ? hexAt(rest.substr(2)) : std::nullopt;
    if (code > 0xDBFF || !low || *low < 0xDC00 || *low > 0xDFFF) return kReplacement;
    used = 10;
    return 0x10000 + ((code - 0xD800) << 10) + (*low - 0xDC00);
}

char plainEscape(char c) {
    switch (c) {
        case 'n': return '\n';
        case 't': return '\t';
        case 'r': return '\r';
        case 'b': return '\b';
        case 'f': return '\f';
        default: return c;
    }
}

}  // namespace

JsonScan::JsonScan(std::string_view text) : text_(text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
}

JsonToken JsonScan::bad(std::string what) {
    if (fault_.empty()) fault_ = std::move(what);
    return JsonToken::Bad;
}

void JsonScan::skipSpace() {
    while (at_ < text_.size() && isSpace(text_[at_])) ++at_;
}

JsonToken JsonScan::next() {
    if (!fault_.empty()) return JsonToken::Bad;
    skipSpace();
    if (valueIsDue_) return value();
    if (open_.empty()) {
        return at_ == text_.size() ? JsonToken::End
                                   : bad("text behind the end: " + shown(text_.substr(at_)));
    }
    if (at_ == text_.size()) return bad("the text ends within an object or an array");
    const bool object = open_.back() == '{';
    if (text_[at_] == (object ? '}' : ']')) {
        ++at_;
        open_.pop_back();
        return afterValue(object ? JsonToken::ObjectEnd : JsonToken::ArrayEnd);
    }
    if (!first_) {
        if (text_[at_] != ',') {
            return bad(shown(text_.substr(at_, 12)) + ", wanted ',' or the end of " +
                       (object ? "an object" : "an array"));
        }
        ++at_;
        skipSpace();
    }
    return object ? key() : value();
}

JsonToken JsonScan::afterValue(JsonToken token) {
    first_ = false;
    valueIsDue_ = false;
    return token;
}

JsonToken JsonScan::open(char kind) {
    if (open_.size() >= kDeepestJson) {
        return bad("nested deeper than " + std::to_string(kDeepestJson));
    }
    ++at_;
    open_.push_back(kind);
    first_ = true;
    valueIsDue_ = false;
    return kind == '{' ? JsonToken::ObjectBegin : JsonToken::ArrayBegin;
}

JsonToken JsonScan::key() {
    if (at_ == text_.size() || text_[at_] != '"') {
        return bad(shown(text_.substr(at_, 12)) + ", wanted a key in double quotes");
    }
    if (!takeString()) return JsonToken::Bad;
    skipSpace();
    if (at_ == text_.size() || text_[at_] != ':') return bad("no ':' behind " + shown(raw_));
    ++at_;
    valueIsDue_ = true;
    return JsonToken::Key;
}

JsonToken JsonScan::value() {
    if (at_ == text_.size()) return bad("the text ends, wanted a value");
    const char c = text_[at_];
    if (c == '{' || c == '[') return open(c);
    if (c == '"') return takeString() ? afterValue(JsonToken::String) : JsonToken::Bad;
    for (const std::string_view literal : {"true", "false", "null"}) {
        if (!text_.substr(at_).starts_with(literal)) continue;
        raw_ = text_.substr(at_, literal.size());
        at_ += literal.size();
        return afterValue(JsonToken::Literal);
    }
    return takeNumber(number_) ? afterValue(JsonToken::Number) : JsonToken::Bad;
}

bool JsonScan::takeString() {
    const std::size_t start = ++at_;
    while (at_ < text_.size() && text_[at_] != '"') {
        if (static_cast<unsigned char>(text_[at_]) < ' ') {
            bad("a control character within a string");
            return false;
        }
        at_ += text_[at_] == '\\' ? 2U : 1U;
    }
    if (at_ >= text_.size()) {
        at_ = text_.size();
        bad("a string does not end");
        return false;
    }
    raw_ = text_.substr(start, at_ - start);
    ++at_;
    return true;
}

bool JsonScan::takeNumber(double& into) {
    const char* const begin = text_.data() + at_;
    const char* const last = text_.data() + text_.size();
    const char* const digit = begin != last && *begin == '-' ? begin + 1 : begin;
    const bool looksRight = digit != last && isDigit(*digit);
    const auto [end, error] = std::from_chars(begin, last, into);
    if (!looksRight || error != std::errc{} || !std::isfinite(into)) {
        const std::size_t word = std::min(text_.find_first_of(",]} \t\r\n", at_), text_.size());
        bad(shown(text_.substr(at_, word - at_)) + ", wanted a finite number");
        return false;
    }
    raw_ = std::string_view(begin, static_cast<std::size_t>(end - begin));
    at_ += raw_.size();
    return true;
}

bool JsonScan::numbers(std::vector<double>& into, bool nulls) {
    if (!fault_.empty()) return false;
    skipSpace();
    while (at_ < text_.size() && text_[at_] != ']') {
        if (!first_) {
            if (text_[at_] != ',') {
                bad(shown(text_.substr(at_, 12)) + ", wanted ',' or ']'");
                return false;
            }
            ++at_;
            skipSpace();
        }
        first_ = false;
        if (nulls && text_.substr(at_).starts_with("null")) {
            at_ += 4;
            number_ = std::numeric_limits<double>::quiet_NaN();
        } else if (!takeNumber(number_)) {
            return false;
        }
        into.push_back(number_);
        skipSpace();
    }
    return next() == JsonToken::ArrayEnd;
}

bool JsonScan::skipRest() {
    const std::size_t depth = open_.size();
    while (open_.size() >= depth) {
        if (next() == JsonToken::Bad) return false;
    }
    return true;
}

bool JsonScan::skipValue() {
    const JsonToken token = next();
    if (token == JsonToken::ObjectBegin || token == JsonToken::ArrayBegin) return skipRest();
    return token != JsonToken::Bad;
}

std::size_t JsonScan::line() const {
    std::size_t count = 1;
    for (std::size_t i = 0; i < at_; ++i) {
        const bool bareReturn = text_[i] == '\r' && (i + 1 == text_.size() || text_[i + 1] != '\n');
        if (text_[i] == '\n' || bareReturn) ++count;
    }
    return count;
}

std::string JsonScan::text() const {
    std::string text;
    text.reserve(raw_.size());
    for (std::size_t i = 0; i < raw_.size(); ++i) {
        if (raw_[i] != '\\' || i + 1 == raw_.size()) {
            text += raw_[i];
        } else if (raw_[++i] == 'u') {
            std::size_t used = 0;
            appendUtf8(text, codeOf(raw_.substr(i + 1), used));
            i += std::min(used, raw_.size() - i - 1);
        } else {
            text += plainEscape(raw_[i]);
        }
    }
    return text;
}

std::string jsonString(std::string_view text) {
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string quoted = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            quoted += '\\';
            quoted += c;
        } else if (c == '\n') {
            quoted += "\\n";
        } else if (code < ' ') {
            quoted += "\\u00";
            quoted += kHex[code >> 4];
            quoted += kHex[code & 15];
        } else {
            quoted += c;
        }
    }
    return quoted + '"';
}

}  // namespace gonio::proc
