#include "proc/core/number_text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace gonio {
namespace {

std::string_view withoutPlus(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    return text;
}

template <class T>
std::optional<T> parseWhole(std::string_view text) {
    text = withoutPlus(text);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

template <class... Args>
std::string toText(Args... args) {
    std::array<char, 400> buffer;  // the longest fixed double has 309 digits before the point
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), args...);
    return error == std::errc{} ? std::string(buffer.data(), end) : std::string("nan");
}

}  // namespace

std::optional<double> parseDouble(std::string_view text) {
    const auto value = parseWhole<double>(text);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    return value;
}

std::optional<LeadingDouble> leadingDouble(std::string_view text) {
    const std::string_view digits = withoutPlus(text);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
    return LeadingDouble{value, static_cast<std::size_t>(end - text.data())};
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
    return parseWhole<std::int64_t>(text);
}

std::string shortest(double value) { return toText(value); }
std::string shortest(float value) { return toText(value); }
void appendShortest(std::string& text, double value) {
    std::array<char, 32> buffer;  // "-2.2250738585072014e-308"
    const auto written = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    text.append(buffer.data(), written.ptr);
}
std::string fixed(double value, int decimals) {
    return toText(value, std::chars_format::fixed, decimals);
}
std::string perCent(double fraction) { return fixed(100 * fraction, 2) + " %"; }

}  // namespace gonio
