#include "sim/pose.h"

#include <Eigen/Geometry>
#include <bit>
#include <cmath>

#include "sim/random.h"

namespace gonio::sim {
namespace {

constexpr std::uint64_t kWaves = 0x7761766573;     // their own stream
constexpr std::uint64_t kWedges = 0x776564676573;  // theirs

Eigen::Matrix3d rotation(const Wedge& wedge) {
    return (Eigen::AngleAxisd(wedge.aboutY.value(), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(wedge.aboutX.value(), Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
}

std::uint64_t bitsOf(Radians angle) { return std::bit_cast<std::uint64_t>(angle.value()); }

}  // namespace

Direction mirrored(const Direction& light, const Wedge& wedge) {
    const Eigen::Vector3d normal =
        Eigen::AngleAxisd(wedge.aboutY.value(), Eigen::Vector3d::UnitY()) *
        (Eigen::AngleAxisd(wedge.aboutX.value(), Eigen::Vector3d::UnitX()) *
         Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d& wi = light.vector();
    return *Direction::fromVector(2 * normal.dot(wi) * normal - wi);
}

Wedge asGround(const Wedge& nominal, std::uint64_t seed, Radians tolerance) {
    if (tolerance == Radians()) return nominal;
    const std::uint64_t key =
        mixed(mixed(mixed(seed, kWedges), bitsOf(nominal.aboutX)), bitsOf(nominal.aboutY));
    return {nominal.aboutX + tolerance * gaussian(key, 0),
            nominal.aboutY + tolerance * gaussian(key, 1)};
}

std::array<Wedge, kLeds> waves(std::uint64_t seed, Radians size) {
    std::array<Wedge, kLeds> spots{};
    if (size == Radians()) return spots;
    const std::uint64_t key = mixed(seed, kWaves);
    Wedge mean;
    for (std::size_t i = 0; i < kLeds; ++i) {
        spots[i] = {Radians(gaussian(key, 2 * i)), Radians(gaussian(key, 2 * i + 1))};
        mean = {mean.aboutX + spots[i].aboutX / kLeds, mean.aboutY + spots[i].aboutY / kLeds};
    }
    double squares = 0;
    for (Wedge& spot : spots) {
        spot = {spot.aboutX - mean.aboutX, spot.aboutY - mean.aboutY};
        squares += std::pow(spot.aboutX.value(), 2) + std::pow(spot.aboutY.value(), 2);
    }
    const double scale = size.value() / std::sqrt(squares / kLeds);
    for (Wedge& spot : spots) spot = {spot.aboutX * scale, spot.aboutY * scale};
    return spots;
}

Pose::Pose(const Wedge& surface, const Wedge& spot, Radians turned)
    : flat_(surface.flat() && spot.flat() && turned == Radians()),
      toSurface_((rotation(surface) * rotation(spot) *
                  Eigen::AngleAxisd(turned.value(), Eigen::Vector3d::UnitZ()).toRotationMatrix())
                     .transpose()) {}

Direction Pose::seenFromSurface(const Direction& d) const {
    if (flat_) return d;
    return *Direction::fromVector(toSurface_ * d.vector());
}

}  // namespace gonio::sim
