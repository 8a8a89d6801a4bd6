#pragma once
// The LEDs' own bands: R, G, B = 630, 525, 465 nm, in this order in memory, files, protocol and
// API. They are never silently a colour space: only named functions convert.

#include <array>
#include <cstddef>
#include <string_view>

namespace gonio {

enum class Band : unsigned char {
    R = 0,
    G = 1,
    B = 2
};

inline constexpr std::array<Band, 3> kBands{Band::R, Band::G, Band::B};
inline constexpr std::array<double, 3> kBandNanometres{630.0, 525.0, 465.0};

constexpr std::size_t index(Band band) { return static_cast<std::size_t>(band); }
constexpr double nanometres(Band band) { return kBandNanometres[index(band)]; }
constexpr std::string_view letter(Band band) {
    return std::string_view("rgb").substr(index(band), 1);
}

/// One number per LED band.
struct LedBands {
    std::array<double, 3> value{0, 0, 0};

    [[nodiscard]] static constexpr LedBands all(double v) { return {{v, v, v}}; }
    constexpr double& operator[](Band b) { return value[index(b)]; }
    constexpr double operator[](Band b) const { return value[index(b)]; }
    constexpr bool operator==(const LedBands&) const = default;

    constexpr LedBands operator+(const LedBands& o) const {
        return {{value[0] + o.value[0], value[1] + o.value[1], value[2] + o.value[2]}};
    }
    constexpr LedBands operator*(const LedBands& o) const {
        return {{value[0] * o.value[0], value[1] * o.value[1], value[2] * o.value[2]}};
    }
    constexpr LedBands operator*(double k) const { return *this * all(k); }
};

}  // namespace gonio
