#pragma once
// What the tilt is fitted to: the measured cells of an LED, and what a Lambert floor and a GGX lobe
// on a tilted surface show in them. f in 1/sr.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "proc/quality/tilt.h"

namespace gonio::proc {

/// One measured cell, the mean of the bands that were measured.
struct Sighting {
    Direction wi, wo;
    std::size_t cell = 0;
    double f = 0, u = 0;
    double sigma = 0;  ///< how far a fitted f may be off
    bool inLobe = false;
};

using Sightings = std::vector<Sighting>;
/// The cells of its lobe and some others, the mean of the bands; thinned.
[[nodiscard]] Sightings sightingsOf(const LedTable& led);

[[nodiscard]] Eigen::Matrix3d toSurface(const Direction& normal);

/// f of a floor and a lobe of strength 1, in the surface's frame and as the rig sees them.
struct Parts {
    double floor = 0, lobe = 0;
};

struct Shape {
    double alpha = 0.1, f0 = 0.04;
};
[[nodiscard]] Parts partsOf(const Shape& shape, const Eigen::Matrix3d& turn, const LightView& pair);
/// As each sighting shows them.
[[nodiscard]] std::vector<Parts> partsOf(std::span<const Sighting> sightings,
                                         const Shape& shape,
                                         const Eigen::Matrix3d& turn);

/// How strong floor and lobe are under one LED: linear least squares.
[[nodiscard]] TiltLobe strengths(std::span<const Sighting> sightings,
                                 const Shape& shape,
                                 const Eigen::Matrix3d& turn);

[[nodiscard]] double shownBy(const TiltLobe& lobe, const Parts& parts);
[[nodiscard]] double shownBy(const TiltLobe& lobe,
                             const Eigen::Matrix3d& turn,
                             const LightView& pair);

/// (measured - fitted) over what that may be, of one LED.
void residualsOf(std::span<const Sighting> sightings,
                 const Shape& shape,
                 const Direction& normal,
                 std::span<double> out);

}  // namespace gonio::proc
