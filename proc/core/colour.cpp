#include "proc/core/colour.h"

#include <Eigen/Core>
#include <Eigen/LU>

namespace gonio {
namespace {

/// XYZ of the primaries with xy (0.64, 0.33), (0.30, 0.60), (0.15, 0.06) under the white (0.3127,
/// 0.3290), by the definition: the columns scaled so that R = G = B = 1 is the white.
Eigen::Matrix3d srgbToXyz() {
    const auto ofChromaticity = [](double x, double y) {
        return Eigen::Vector3d(x / y, 1, (1 - x - y) / y);
    };
    Eigen::Matrix3d primaries;
    primaries.col(0) = ofChromaticity(0.64, 0.33);
    primaries.col(1) = ofChromaticity(0.30, 0.60);
    primaries.col(2) = ofChromaticity(0.15, 0.06);
    const Eigen::Vector3d scale = primaries.inverse() * ofChromaticity(0.3127, 0.3290);
    return primaries * scale.asDiagonal();
}

std::array<double, 3> times(const Eigen::Matrix3d& matrix, const std::array<double, 3>& v) {
    const Eigen::Vector3d out = matrix * Eigen::Vector3d(v[0], v[1], v[2]);
    return {out.x(), out.y(), out.z()};
}

}  // namespace

LinearSrgb toLinearSrgb(const Xyz& xyz) {
    static const Eigen::Matrix3d kMatrix = srgbToXyz().inverse();
    return {times(kMatrix, xyz.value)};
}

Xyz toXyz(const LinearSrgb& rgb) {
    static const Eigen::Matrix3d kMatrix = srgbToXyz();
    return {times(kMatrix, rgb.value)};
}

}  // namespace gonio
