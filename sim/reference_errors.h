#pragma once
// How wrong the reference tiles really are, against their certificates: the white by 0.5 % common
// to all, and 0.3 % per direction, LED and band (a smooth field with unit variance everywhere); the
// black by 10 % of its reflectance; the light trap, which is taken for f = 0, by 1e-5 / sr. One
// draw is one laboratory's references.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/direction.h"
#include "proc/core/result.h"

namespace gonio::sim {

inline constexpr int kStrata = 20;

/// The factors of the white under one LED: ReferenceErrors::white with its nodes in a table.
/// Directions above the horizon, here and there.
class WhiteErrors {
public:
    [[nodiscard]] LedBands factor(const Direction& wo) const;

private:
    friend class ReferenceErrors;
    double common_ = 1;
    std::vector<LedBands> nodes_;  ///< the field's deviates, by node; empty: no errors
};

class ReferenceErrors {
public:
    /// All errors zero.
    ReferenceErrors() = default;
    [[nodiscard]] static ReferenceErrors random(std::uint64_t seed);
    /// Run 0..19 of 20: over the runs each component takes each of its 20 quantiles (k + 0.5) / 20
    /// once, in an order of its own. The orders are fixed: runs may differ in their noise's seed.
    [[nodiscard]] static ReferenceErrors stratified(int run);
    /// "none", "random" or "stratum:K".
    [[nodiscard]] static Result<ReferenceErrors> parse(std::string_view text, std::uint64_t seed);

    /// Factors on the certified f.
    [[nodiscard]] double white(int led, Band band, const Direction& wo) const;
    /// The same for many directions: all that does not depend on them, worked out once.
    [[nodiscard]] WhiteErrors white(int led) const;
    [[nodiscard]] double black() const;
    /// f of the light trap, 1/sr, alike in all directions and bands. Never below 0: its root mean
    /// square over the draws is 1e-5.
    [[nodiscard]] double zero() const;

    /// Standard deviate of a component, for tests: 0 common white, 1 black, from 2 on field nodes,
    /// 1 << 32 zero.
    [[nodiscard]] double deviate(std::uint64_t component) const;
    /// The field of the white: standard normal at every direction.
    [[nodiscard]] double field(int led, Band band, const Direction& wo) const;

private:
    enum class Kind {
        None,
        Random,
        Stratified
    };
    Kind kind_ = Kind::None;
    int run_ = 0;
    std::uint64_t seed_ = 0;
};

}  // namespace gonio::sim
