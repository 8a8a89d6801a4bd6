#pragma once
// Where a value came from and what was done to it. The same bit mask in memory, files and API; CSV
// holds the decimal mask. Bit numbers are a contract (DESIGN.md 3).

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace gonio {

enum class Flag : std::uint8_t {
    Measured = 0,
    Saturated = 1,
    BelowNoise = 2,
    Blocked = 3,  ///< by the optics
    BelowHorizon = 4,
    Reciprocity = 5,
    Interpolated = 6,
    Prior = 7,
    Model = 8,
    Extrapolated = 9,
    GlareCorrected = 10,
    TiltCorrected = 11,
    DriftCorrected = 12,
    NotPlanned = 13,
};
inline constexpr int kFlagCount = 14;

class Flags {
public:
    constexpr Flags() = default;
    constexpr Flags(std::initializer_list<Flag> flags) {
        for (Flag f : flags) set(f);
    }
    [[nodiscard]] static constexpr Flags fromMask(std::uint32_t mask) {
        Flags flags;
        flags.mask_ = mask;
        return flags;
    }
    [[nodiscard]] constexpr std::uint32_t mask() const { return mask_; }
    [[nodiscard]] constexpr bool has(Flag f) const { return (mask_ & bit(f)) != 0; }
    constexpr Flags& set(Flag f) {
        mask_ |= bit(f);
        return *this;
    }
    constexpr Flags& clear(Flag f) {
        mask_ &= ~bit(f);
        return *this;
    }
    constexpr Flags operator|(Flags o) const { return fromMask(mask_ | o.mask_); }
    constexpr bool operator==(const Flags&) const = default;

private:
    static constexpr std::uint32_t bit(Flag f) { return 1U << static_cast<unsigned>(f); }
    std::uint32_t mask_ = 0;
};

/// "measured", "below_noise", ...: the names in JSON.
[[nodiscard]] std::string_view name(Flag flag);
/// Comma-separated names, in bit order.
[[nodiscard]] std::string describe(Flags flags);

enum class Source : std::uint8_t {
    Measured,
    Reciprocity,
    Interpolated,
    Prior,
    Model,
    Extrapolated,
    Analytic,
};
[[nodiscard]] std::string_view name(Source source);

}  // namespace gonio
