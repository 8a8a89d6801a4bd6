#pragma once
// A JSON text as tokens, one after another, without a tree: for files whose arrays are too long to
// be kept twice. Nesting is at most kDeepestJson; the first fault ends the text and says what was
// there. Numbers are finite. A byte order mark at the beginning is skipped. Strings may hold any
// bytes but control characters; escapes are resolved when a string is asked for.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::proc {

enum class JsonToken {
    ObjectBegin,
    ObjectEnd,
    ArrayBegin,
    ArrayEnd,
    Key,
    String,
    Number,
    Literal,  ///< true, false, null
    End,
    Bad  ///< see fault(); from then on always
};

inline constexpr std::size_t kDeepestJson = 64;

class JsonScan {
public:
    explicit JsonScan(std::string_view text);

    JsonToken next();
    /// The bytes of the last key, string (without quotes), number or literal.
    [[nodiscard]] std::string_view raw() const { return raw_; }
    /// The last key or string with its escapes resolved; what is no UTF-16 becomes U+FFFD.
    [[nodiscard]] std::string text() const;
    /// The last number.
    [[nodiscard]] double number() const { return number_; }

    /// Behind ArrayBegin: all numbers up to the array's end, which is taken, too. False, with a
    /// fault, for anything else; null is NaN where `nulls` says so.
    bool numbers(std::vector<double>& into, bool nulls = false);
    /// Passes over the value that comes next, or, behind a Begin, nothing but that value's rest.
    bool skipValue();
    bool skipRest();

    [[nodiscard]] const std::string& fault() const { return fault_; }
    /// Of what was read last.
    [[nodiscard]] std::size_t line() const;
    [[nodiscard]] std::size_t bytesLeft() const { return text_.size() - at_; }

private:
    JsonToken bad(std::string what);
    void skipSpace();
    JsonToken afterValue(JsonToken token);
    JsonToken value();
    JsonToken key();
    JsonToken open(char kind);
    bool takeString();
    bool takeNumber(double& into);

    std::string_view text_;
    std::size_t at_ = 0;
    std::string_view raw_;
    double number_ = 0;
    std::vector<char> open_;  ///< '{' or '['
    bool first_ = true;       ///< of its object or array
    bool valueIsDue_ = true;  ///< at the beginning, and behind a key
    std::string fault_;
};

/// In quotes, with what JSON wants escaped.
[[nodiscard]] std::string jsonString(std::string_view text);

}  // namespace gonio::proc
