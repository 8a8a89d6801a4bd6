#include "proc/report/report_words.h"

#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr const char* kPlusMinus = " \xC2\xB1 ";  // U+00B1
constexpr double kSmall = 1e-3, kLarge = 1e5;     // beyond, an exponent

/// The decade of a number other than 0, after it was rounded to so many digits: 9.97 to two digits
/// is 10.
int decadeOf(double value, int digits) {
    const double size = std::abs(value);
    const int decade = static_cast<int>(std::floor(std::log10(size)));
    const double scale = std::pow(10.0, decade - digits + 1);
    return std::round(size / scale) >= std::pow(10.0, digits) ? decade + 1 : decade;
}

/// Rounded at a decimal place, which may lie left of the point.
std::string atDecimals(double value, int decimals) {
    const double step = decimals < 0 ? std::pow(10.0, -decimals) : 1;
    const std::string text = decimals < 0 ? fixed(std::round(value / step) * step, 0)
                                          : fixed(value, std::min(decimals, 15));
    const bool zero = text.find_first_not_of("-0.") == std::string::npos;
    return zero && text.front() == '-' ? text.substr(1) : text;
}

std::string exponent(int decade) { return "e" + std::to_string(decade); }

}  // namespace

std::string significant(double value, int digits) {
    if (!std::isfinite(value)) return "none";
    if (value == 0) return "0";
    const int decade = decadeOf(value, digits);
    if (decade >= -4 && decade < 6) return atDecimals(value, digits - 1 - decade);
    return fixed(value / std::pow(10.0, decade), digits - 1) + exponent(decade);
}

std::string withExpanded(double value, std::optional<double> u) {
    if (!std::isfinite(value)) return "none";
    if (!u || !std::isfinite(*u) || *u < 0) return significant(value, 3) + " (u not known)";
    const double expanded = kCoverageFactor * *u;
    if (expanded == 0) return significant(value, 6) + kPlusMinus + "0";
    const double larger = std::max(std::abs(value), expanded);
    if (larger >= kSmall && larger < kLarge) {
        const int decimals = 1 - decadeOf(expanded, 2);
        return atDecimals(value, decimals) + kPlusMinus + atDecimals(expanded, decimals);
    }
    const int decade = decadeOf(larger, 2);
    const double scale = std::pow(10.0, decade);
    const int decimals = 1 - decadeOf(expanded / scale, 2);
    return "(" + atDecimals(value / scale, decimals) + kPlusMinus +
           atDecimals(expanded / scale, decimals) + ")" + exponent(decade);
}

std::string relativeText(double fraction) {
    const std::string text = significant(100 * fraction, 2);
    return text == "none" || text == "0" ? text : text + " %";
}

std::string sizeText(double size, const std::string& unit) {
    return unit == "relative" ? relativeText(size) : significant(size, 2) + " " + unit;
}

std::string shareText(double fraction) {
    if (!std::isfinite(fraction)) return "none";
    constexpr double kRounding = 1e-9;  // of a sum over a hemisphere's cells
    if (fraction < kRounding) return "0";
    if (fraction < 0.0005) return "< 0.1 %";
    return fixed(100 * fraction, 1) + " %";
}

std::string orNotSaid(const std::string& words) { return words.empty() ? "not said" : words; }

}  // namespace gonio::proc
