#include "proc/quality/seen_direction.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

using Turns = Eigen::Matrix<double, 3, 2>;  // d m / d rho, about two axes across the normal

Eigen::Vector3d mirrored(const Eigen::Vector3d& light, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d n = normal.normalized();
    return 2 * n.dot(light) * n - light;
}

Turns turnsOf(const Eigen::Vector3d& light, const Eigen::Vector3d& normal) {
    constexpr double kStep = 1e-5;
    const Eigen::Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
    Turns turns;
    turns.col(0) =
        (mirrored(light, normal + kStep * x) - mirrored(light, normal - kStep * x)) / (2 * kStep);
    turns.col(1) =
        (mirrored(light, normal + kStep * y) - mirrored(light, normal - kStep * y)) / (2 * kStep);
    return turns;
}

}  // namespace

SeenDirection::SeenDirection(const LensFit& lens,
                             const std::vector<Radians>& incidences,
                             const TiltEstimate& estimate)
    : lens_(lens), lobes_(incidences.size()) {
    const Eigen::Vector3d normal = estimate.joint.direction.vector();
    Eigen::Matrix2d weights = Eigen::Matrix2d::Zero();
    Eigen::Matrix<double, 2, LensMap::kParameters> pull =
        Eigen::Matrix<double, 2, LensMap::kParameters>::Zero();
    std::vector<Turns> turns;
    for (std::size_t led = 0; led < incidences.size(); ++led) {
        const Direction light = Direction::fromSpherical(incidences[led], Radians(0));
        turns.push_back(turnsOf(light.vector(), normal));
        lobes_[led].at = mirrored(light.vector(), normal);
        if (led >= estimate.leds.size() || !estimate.leds[led]) continue;
        const auto lobe = Direction::fromVector(lobes_[led].at);
        const auto slopes = lobe ? lens_.slopes(*lobe) : std::nullopt;
        const double u = estimate.leds[led]->uSeen.perAxis().value();
        if (!slopes || !(u > 0)) continue;
        weights += turns[led].transpose() * turns[led] / (u * u);
        pull -= turns[led].transpose() * *slopes / (u * u);
    }
    const Eigen::FullPivLU<Eigen::Matrix2d> solver(weights);
    if (!solver.isInvertible()) return;  // no lobe: all of the lens map's error is left
    for (std::size_t led = 0; led < incidences.size(); ++led)
        lobes_[led].taken = turns[led] * solver.solve(pull);
}

DirectionSpread SeenDirection::uncertainty(std::size_t led, const Direction& wo) const {
    const auto slopes = lens_.slopes(wo);
    if (!slopes) return DirectionSpread::even(Radians(kPi));
    const Lobe& lobe = lobes_[led];
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond::FromTwoVectors(lobe.at, wo.vector()).toRotationMatrix();
    return lens_.ofSlopes(wo, *slopes + turn * lobe.taken);
}

// All lobes lie along x. One that is seen e off its place along theta shows a normal that is e / 2
// off; along phi, across the plane of incidence, e / (2 cos(theta)).
TurnUncertainty SeenDirection::wavesBeyondTheMap(const TiltEstimate& estimate) const {
    double x = 0, y = 0;
    int count = 0;
    for (std::size_t led = 0; led < lobes_.size(); ++led) {
        if (led >= estimate.leds.size() || !estimate.leds[led]) continue;
        const auto lobe = Direction::fromVector(lobes_[led].at);
        if (!lobe || !lobe->aboveHorizon()) continue;
        const DirectionSpread spread = uncertainty(led, *lobe);
        x += std::pow(spread.alongTheta.value() / 2, 2);
        y += std::pow(spread.alongPhi.value() / (2 * lobe->z()), 2);
        ++count;
    }
    if (count == 0) return estimate.waves;
    const auto rest = [&](Radians waves, double map) {
        return Radians(std::sqrt(std::max(0.0, waves.value() * waves.value() - map / count)));
    };
    return {rest(estimate.waves.towardX, x), rest(estimate.waves.towardY, y)};
}

}  // namespace gonio::proc
