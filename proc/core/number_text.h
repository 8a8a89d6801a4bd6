#pragma once
// Numbers as text, the same in every locale: the whole text must be one finite number, and what is
// written reads back to the same bits in the fewest digits.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gonio {

/// Empty unless all of `text` is one finite decimal number ("1", "-2.5e-3"; a leading + is
/// allowed).
[[nodiscard]] std::optional<double> parseDouble(std::string_view text);
/// The number with which `text` begins, and how many bytes it takes; empty unless it is finite.
/// What follows is the caller's to judge: one pass over a long text of numbers.
struct LeadingDouble {
    double value = 0;
    std::size_t length = 0;
};
[[nodiscard]] std::optional<LeadingDouble> leadingDouble(std::string_view text);
/// Empty unless all of `text` is one decimal integer that fits.
[[nodiscard]] std::optional<std::int64_t> parseInteger(std::string_view text);
/// Shortest digits that read back to the same double; "nan", "inf", "-inf" where it is none.
[[nodiscard]] std::string shortest(double value);
[[nodiscard]] std::string shortest(float value);
/// shortest(), at the end of `text`.
void appendShortest(std::string& text, double value);
/// Fixed number of decimals, for tables and labels.
[[nodiscard]] std::string fixed(double value, int decimals);
/// A fraction as "1.25 %".
[[nodiscard]] std::string perCent(double fraction);

}  // namespace gonio
