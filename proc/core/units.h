#pragma once
// Units that carry meaning. Radians is the only angle in memory; degrees exist as the literal
// `_deg` and through fromDegrees/degrees at file and screen edges.

#include <chrono>
#include <cmath>
#include <compare>
#include <cstdint>
#include <numbers>

namespace gonio {

inline constexpr double kPi = std::numbers::pi;

/// A plane angle in radians.
class Radians {
public:
    constexpr Radians() = default;
    constexpr explicit Radians(double value) : value_(value) {}
    [[nodiscard]] static constexpr Radians fromDegrees(double degrees) {
        return Radians(degrees * (kPi / 180.0));
    }

    [[nodiscard]] constexpr double value() const { return value_; }
    [[nodiscard]] constexpr double degrees() const { return value_ * (180.0 / kPi); }

    constexpr auto operator<=>(const Radians&) const = default;
    constexpr Radians operator-() const { return Radians(-value_); }
    constexpr Radians operator+(Radians o) const { return Radians(value_ + o.value_); }
    constexpr Radians operator-(Radians o) const { return Radians(value_ - o.value_); }
    constexpr Radians operator*(double k) const { return Radians(value_ * k); }
    constexpr Radians operator/(double k) const { return Radians(value_ / k); }

private:
    double value_ = 0;
};

constexpr Radians operator""_deg(long double degrees) {
    return Radians::fromDegrees(static_cast<double>(degrees));
}
constexpr Radians operator""_deg(unsigned long long degrees) {
    return Radians::fromDegrees(static_cast<double>(degrees));
}

inline double sin(Radians a) { return std::sin(a.value()); }
inline double cos(Radians a) { return std::cos(a.value()); }
inline double tan(Radians a) { return std::tan(a.value()); }

using Seconds = std::chrono::duration<double>;
using Nanoseconds = std::chrono::duration<std::int64_t, std::nano>;
using Microseconds = std::chrono::duration<std::int64_t, std::micro>;

/// Devices quantise: what was asked for and what was really granted (the true one).
struct Exposure {
    Microseconds requested{0};
    Nanoseconds granted{0};

    [[nodiscard]] double seconds() const { return static_cast<double>(granted.count()) * 1e-9; }
    bool operator==(const Exposure&) const = default;
};

}  // namespace gonio
