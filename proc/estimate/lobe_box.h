#pragma once
// The coordinates of a baked table: three numbers of a pair of directions that are all an
// isotropic, reciprocal and plane-symmetric f depends on, and that fill a box.
//   tanHalf   T = tan(theta_h), in [0, inf)
//   cosDiff   m = wi.h, in (0, 1]
//   skew      c = q / min(1, P) in [0, 1], q = |cos(theta_i) - cos(theta_o)| / (cos(theta_i) +
//             cos(theta_o)), P = tan(theta_h) tan(theta_d)
// They come from half and difference angles [Rusinkiewicz1998] with phi_d replaced: cos(theta_i)
// and cos(theta_o) are cos(theta_h) cos(theta_d) (1 +- q), and q = P |cos(phi_d)|. So c is
// |cos(phi_d)| as long as every phi_d is above the horizon (P < 1), and elsewhere c = 1 is the
// horizon: no corner of the box lies below it, so that nothing is interpolated with directions that
// do not exist. All three are algebraic in the vectors. At theta_h = 0 or theta_d = 0, c means
// nothing.
//
// The nodes: T by ln(1 + T / t0) up to kMostTan (theta_h = 89.5 degrees), as fine as t0 at the peak
// and even in the logarithm in the tails; m by its root, dense at grazing light; c evenly.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "proc/models/fast_exp.h"
#include "proc/models/kernel.h"

namespace gonio::proc {

template <class T>
struct BoxPoint {
    T tanHalf, cosDiff, skew;
};

/// Both directions above the horizon. Sums and differences of directions are taken in their own
/// number type, so that a sharp lobe keeps its digits; what follows is good enough in float. m and
/// c may exceed 1 by rounding.
template <class T>
[[nodiscard]] BoxPoint<float> boxPoint(const Pair<T>& pair) {
    const auto narrow = [](const Vec<T>& v) {
        return Vec<float>{
            static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    const Vec<float> h = narrow(pair.in + pair.out);
    const Vec<float> d =
        narrow({pair.in.x - pair.out.x, pair.in.y - pair.out.y, pair.in.z - pair.out.z});
    const float sin2 = h.x * h.x + h.y * h.y;
    const float length2 = sin2 + h.z * h.z;
    const float inverse = 1 / h.z;
    // q / P = |cos(phi_d)| as one quotient; c = max(q, q / P). Both are worked out: a branch that
    // nobody can foresee costs more.
    const float q = std::abs(d.z) * inverse;
    constexpr float kLeast = 1e-30F;  // d.z is 0 with the product
    const float cosPhi = std::abs(d.z) * std::sqrt(length2 / (sin2 * dot(d, d) + kLeast));
    return {std::sqrt(sin2) * inverse, std::sqrt(length2) / 2, cosPhi > q ? cosPhi : q};
}

struct BoxResolution {
    int tanHalf = 128, cosDiff = 48, skew = 12;

    [[nodiscard]] std::size_t nodes() const {
        return static_cast<std::size_t>(tanHalf) * static_cast<std::size_t>(cosDiff) *
               static_cast<std::size_t>(skew);
    }
    bool operator==(const BoxResolution&) const = default;
};

/// The low corner of the cell that a point lies in, and how far along each of its edges.
struct BoxPlace {
    std::int32_t node = 0;
    float tanHalf = 0, cosDiff = 0, skew = 0;  ///< in [0, 1], or NaN
};

/// Node (i, j, k) of T, m, c is number (i nodes_m + j) nodes_c + k.
class BoxAxes {
public:
    static constexpr double kMostTan = 115;

    BoxAxes() : BoxAxes(BoxResolution{}, 1) {}
    /// Two nodes or more along each axis; t0 > 0.
    BoxAxes(const BoxResolution& resolution, double t0)
        : resolution_(resolution),
          t0_(t0),
          perOctave_((resolution.tanHalf - 1) / std::log2(1 + kMostTan / t0)),
          scale_{static_cast<float>(1 / t0),
                 static_cast<float>(perOctave_),
                 static_cast<float>(resolution.cosDiff - 1),
                 static_cast<float>(resolution.skew - 1)} {}

    [[nodiscard]] const BoxResolution& resolution() const { return resolution_; }
    [[nodiscard]] double t0() const { return t0_; }

    /// The coordinates of a point counted in nodes, whole or not.
    [[nodiscard]] BoxPoint<double> pointAt(const BoxPoint<double>& node) const {
        const double root = node.cosDiff / (resolution_.cosDiff - 1);
        return {.tanHalf = t0_ * std::expm1(node.tanHalf / perOctave_ * std::log(2.0)),
                .cosDiff = root * root,
                .skew = node.skew / (resolution_.skew - 1)};
    }

    /// Points beyond the last node are on it. A NaN is at the first, a NaN along: no index is ever
    /// outside.
    [[nodiscard]] BoxPlace placeOf(const BoxPoint<float>& point) const {
        const Octave<float> octave = octaveOf(1 + point.tanHalf * scale_.perT0);
        const float logarithm = octave.octave + fastLog2Near1<5>(octave.s);
        const Step t = stepOf(logarithm * scale_.perOctave, resolution_.tanHalf);
        const Step m = stepOf(std::sqrt(point.cosDiff) * scale_.cosDiff, resolution_.cosDiff);
        const Step c = stepOf(point.skew * scale_.skew, resolution_.skew);
        return {(t.low * resolution_.cosDiff + m.low) * resolution_.skew + c.low,
                t.share,
                m.share,
                c.share};
    }

private:
    struct Step {
        std::int32_t low;
        float share;
    };
    [[nodiscard]] static Step stepOf(float at, int nodes) {
        // Written so that a NaN becomes 0.
        const float least = at > 0 ? at : 0;
        const auto most = static_cast<float>(nodes - 1);
        const float bounded = least < most ? least : most;
        const auto low = std::min(static_cast<std::int32_t>(bounded), nodes - 2);
        return {low, at == at ? bounded - static_cast<float>(low) : at};
    }
    /// What a look-up multiplies with, in its own precision.
    struct Scale {
        float perT0, perOctave, cosDiff, skew;
    };

    BoxResolution resolution_;
    double t0_;
    double perOctave_;  ///< nodes of T to a factor of 2 of 1 + T / t0
    Scale scale_;
};

}  // namespace gonio::proc
