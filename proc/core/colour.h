#pragma once
// Conversions between colour spaces, each a function that names its assumption. The bands of the
// LEDs are no colour space: nothing here takes or gives them.

#include <array>

namespace gonio {

/// CIE 1931 tristimulus values, Y of a perfect diffuser under the illuminant is 1.
struct Xyz {
    std::array<double, 3> value{0, 0, 0};
};

/// Linear sRGB (Rec. 709 primaries, D65), before the transfer curve; may be negative out of gamut.
struct LinearSrgb {
    std::array<double, 3> value{0, 0, 0};
};

/// The matrix of [IEC61966], to the digits that invert to themselves: D65, no adaptation.
[[nodiscard]] LinearSrgb toLinearSrgb(const Xyz& xyz);
[[nodiscard]] Xyz toXyz(const LinearSrgb& rgb);

}  // namespace gonio
