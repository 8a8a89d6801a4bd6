#include "sim/source_disc.h"

#include <Eigen/Geometry>
#include <cmath>

namespace gonio::sim {

std::array<SourcePoint, kSourcePoints> sourceDisc(const Direction& middle, Radians diameter) {
    std::array<SourcePoint, kSourcePoints> points{};
    points[0] = {middle, 1.0 / 4};
    const Eigen::Vector3d across = middle.vector().unitOrthogonal();
    const Eigen::Vector3d along = middle.vector().cross(across);
    const double angle = std::sqrt(2.0 / 3) * diameter.value() / 2;
    for (std::size_t i = 1; i < kSourcePoints; ++i) {
        const double around = 2 * kPi * static_cast<double>(i) / (kSourcePoints - 1);
        const Eigen::Vector3d toward = std::cos(around) * across + std::sin(around) * along;
        points[i] = {
            *Direction::fromVector(std::cos(angle) * middle.vector() + std::sin(angle) * toward),
            1.0 / 8};
    }
    return points;
}

}  // namespace gonio::sim
