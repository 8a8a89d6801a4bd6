#pragma once
// The hemisphere of wo as seen from the lobe of a given wi: polar coordinates of the slope of the
// half vector, h = (T cos(phi), T sin(phi), 1) / sqrt(1 + T^2), phi from the azimuth of wi.
// Whatever the width of a lobe about the mirror direction, it is smooth in ln(T); the horizon of wo
// is the curve
//     Tmax(phi) = tan(theta_i) cos(phi) + sqrt(1 + tan^2(theta_i) cos^2(phi)),
// and with mu_i = cos(theta_i)
//     cos(theta_o) = mu_i (Tmax - T) (T + 1/Tmax) / (1 + T^2), which has no difference that
//     cancels, cos(theta_o) dwo = 4 cos(theta_o) (sin(theta_i) T cos(phi) + mu_i) T dT dphi / (1 +
//     T^2)^2.
//
// The coordinates are drawn to a square: x in [0, 4] runs around, a unit each quarter, nodes drawn
// to phi = 90 and 270 degrees by a cube, where Tmax turns within mu_i of it at grazing light;
// y in [0, kRings] runs from the mirror direction outwards, T / Tmax linear to 1e-6 in the first
// unit and then by a factor of 16 each.

#include "proc/core/direction.h"

namespace gonio::proc {

/// One value of x.
struct Spoke {
    double cosPhi, sinPhi;
    double tMax;
    double weight;  ///< dphi / dx
};

/// One value of y.
struct Ring {
    double share;   ///< T / Tmax
    double weight;  ///< dT / Tmax / dy
};

/// A direction and the projected solid angle, sr, that a unit of x times y holds there.
struct ProjectedNode {
    Direction wo;
    double projected = 0;
};

class LobePolar {
public:
    static constexpr int kQuarters = 4;
    static constexpr int kRings = 6;

    /// wi above the horizon.
    explicit LobePolar(const Direction& wi);

    [[nodiscard]] Spoke spoke(double x) const;
    [[nodiscard]] static Ring ring(double y);
    /// At and above the horizon.
    [[nodiscard]] ProjectedNode at(const Spoke& spoke, const Ring& ring) const;

private:
    double mu_, sinTheta_;
    double cosAzimuth_, sinAzimuth_;
};

}  // namespace gonio::proc
