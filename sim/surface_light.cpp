#include "sim/surface_light.h"

#include <cmath>

#include "sim/band_mixture.h"

namespace gonio::sim {
namespace {

double orZero(double f) { return std::isfinite(f) ? f : 0; }

Pose poseOf(const Placement& placement, const Flaws& flaws, int led) {
    if (placement.role != Role::Sample) return {};
    const auto spots = waves(flaws.seed, placement.errors.waviness);
    return {placement.wedge, spots[static_cast<std::size_t>(led)], placement.turned};
}

Direction turnedBy(Radians angle, const Direction& wo) {
    if (angle == Radians()) return wo;
    return Direction::fromSpherical(wo.theta(), wo.phi() + angle);
}

std::vector<SourcePoint> sourceOf(const Flaws& flaws, int led, const Pose& pose) {
    const Direction middle = ledDirection(led);
    std::vector<SourcePoint> points{{middle, 1}};
    if (flaws.rig.sourceDiameter > Radians()) {
        const auto disc = sourceDisc(middle, flaws.rig.sourceDiameter);
        points.assign(disc.begin(), disc.end());
    }
    for (SourcePoint& point : points) point.direction = pose.seenFromSurface(point.direction);
    return points;
}

}  // namespace

SurfaceLight::SurfaceLight(const Placement& placement, const Flaws& flaws, int led)
    : surface_(placement.surface),
      pose_(poseOf(placement, flaws, led)),
      source_(sourceOf(flaws, led, pose_)),
      turned_(placement.turned),
      crosstalk_(flaws.rig.crosstalk) {
    if (placement.role == Role::Sample) subsurface_ = subsurface(placement.errors);
    if (placement.role == Role::White) white_ = flaws.references.white(led);
    if (placement.role == Role::Black) black_ = flaws.references.black();
    if (placement.role == Role::Zero) zero_ = flaws.references.zero();
}

LedBands SurfaceLight::meanOverSource(const Direction& out) const {
    const Answer middle = surface_->answer({.in = source_.front().direction, .out = out});
    LedBands f;
    for (Band b : kBands) f[b] = orZero(middle.f[b]) * source_.front().weight;
    for (std::size_t i = 1; i < source_.size(); ++i) {
        const Answer rim = surface_->answer({.in = source_[i].direction, .out = out});
        const LedBands& there = rim.present() ? rim.f : middle.f;
        for (Band b : kBands) f[b] += orZero(there[b]) * source_[i].weight;
    }
    return f;
}

LedBands SurfaceLight::towards(const Direction& wo) const {
    if (surface_ == nullptr) return LedBands::all(zero_ * wo.z());
    const Direction out = pose_.seenFromSurface(wo);
    if (!out.aboveHorizon()) return {};
    const LedBands f = bandMixture(meanOverSource(out) + subsurface_, crosstalk_);
    const LedBands white = white_.factor(turnedBy(-turned_, wo));
    LedBands light;
    for (Band b : kBands) light[b] = f[b] * out.z() * white[b] * black_;
    return light;
}

double SurfaceLight::lobeShapeAt(const Direction& wo) const {
    const Direction mirror = mirrorOf(source_.front().direction);
    return lobeShape(angleBetween({mirror, pose_.seenFromSurface(wo)}));
}

}  // namespace gonio::sim
