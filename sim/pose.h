#pragma once
// How a surface lies under the rig: the rig's directions seen in the surface's own frame.

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "proc/core/direction.h"
#include "proc/core/units.h"
#include "sim/light.h"

namespace gonio::sim {

/// Wedges turn the surface: its normal is n = Ry(aboutY) Rx(aboutX) z.
struct Wedge {
    Radians aboutX{};
    Radians aboutY{};
    [[nodiscard]] bool flat() const { return aboutX == Radians() && aboutY == Radians(); }
};

/// The direction in which a mirror with this wedge shows the LED.
[[nodiscard]] Direction mirrored(const Direction& light, const Wedge& wedge);

/// The wedge that is there for a nominal one: off by the tolerance (k = 1) about either axis, drawn
/// from the seed and the nominal angles, so that the same wedge is always off by the same.
[[nodiscard]] Wedge asGround(const Wedge& nominal, std::uint64_t seed, Radians tolerance);

/// How the spots of the four LEDs on a wavy surface lie, each on a wedge of its own: drawn from the
/// seed, Gaussian about both axes, then brought to mean 0 and to the given root mean square of
/// hypot(aboutX, aboutY). Size 0: flat.
[[nodiscard]] std::array<Wedge, kLeds> waves(std::uint64_t seed, Radians size);

/// A surface on one wedge, its spot on another, and turned about its own normal by `turned`,
/// counter-clockwise seen from above.
class Pose {
public:
    Pose() = default;
    Pose(const Wedge& surface, const Wedge& spot, Radians turned = {});

    /// The same direction in the surface's frame; the very same bits when it is flat and
    /// not turned.
    [[nodiscard]] Direction seenFromSurface(const Direction& d) const;

private:
    bool flat_ = true;
    Eigen::Matrix3d toSurface_ = Eigen::Matrix3d::Identity();
};

}  // namespace gonio::sim
