#pragma once
// Numbers of a report: no more digits than their uncertainty allows. U is the expanded uncertainty,
// 2 u (k = 2, about 95 % of a normal distribution), with two significant digits; the value ends at
// the same decimal place [Gum2008, 7.2.6].

#include <optional>
#include <string>

#include "proc/core/units.h"

namespace gonio::proc {

inline constexpr double kCoverageFactor = 2;  ///< k of U

/// "0.7170 +- 0.0052" (with the sign itself), "(3.10 +- 0.66)e-4" where both are below 1e-3 or
/// above 1e5; `u` is standard (k = 1). Without a u that is known: three significant digits and
/// "(u not known)". No finite value: "none".
[[nodiscard]] std::string withExpanded(double value, std::optional<double> u);

/// So many significant digits, never an exponent between 1e-4 and 1e6. "none" for no number.
[[nodiscard]] std::string significant(double value, int digits);
/// A share as per cent with two significant digits: "0.52 %"; "0" of none.
[[nodiscard]] std::string relativeText(double fraction);
/// The size of a budget's component with two significant digits: "0.52 %" of what is relative,
/// else with its unit, "0.0021 1/sr".
[[nodiscard]] std::string sizeText(double size, const std::string& unit);
/// A share of a whole, to a tenth of a per cent: "99.9 %"; "0" of none (rounding below 1e-9 is
/// none), "< 0.1 %" for what is less and not 0.
[[nodiscard]] std::string shareText(double fraction);

/// The words; "not said" for none.
[[nodiscard]] std::string orNotSaid(const std::string& words);

}  // namespace gonio::proc
