#pragma once
// Quantities that do not mix: BRDF and cosine-weighted BRDF (Ars) are different types, and so are
// radiance and counts. Each is a double with a name.

#include <compare>

namespace gonio {

template <class Tag>
class Quantity {
public:
    constexpr Quantity() = default;
    constexpr explicit Quantity(double value) : value_(value) {}
    [[nodiscard]] constexpr double value() const { return value_; }

    constexpr auto operator<=>(const Quantity&) const = default;
    constexpr Quantity operator+(Quantity o) const { return Quantity(value_ + o.value_); }
    constexpr Quantity operator-(Quantity o) const { return Quantity(value_ - o.value_); }
    constexpr Quantity operator*(double k) const { return Quantity(value_ * k); }
    constexpr double operator/(Quantity o) const { return value_ / o.value_; }

private:
    double value_ = 0;
};

using Counts = Quantity<struct CountsTag>;      ///< DN, black level included
using Radiance = Quantity<struct RadianceTag>;  ///< electrons per second at full LED level
using Brdf = Quantity<struct BrdfTag>;          ///< f, 1/sr
using Ars = Quantity<struct ArsTag>;            ///< f cos(theta_o), 1/sr

/// f cos(theta_o). cosThetaOut in [0, 1].
constexpr Ars toArs(Brdf f, double cosThetaOut) { return Ars(f.value() * cosThetaOut); }

/// Below this cosine (89.9943 degrees) an Ars holds no usable f.
inline constexpr double kMinCosForBrdf = 1e-4;

/// f from f cos(theta_o); NaN where cosThetaOut < kMinCosForBrdf: missing is never 0.
[[nodiscard]] Brdf toBrdf(Ars ars, double cosThetaOut);

}  // namespace gonio
