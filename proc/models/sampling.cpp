#include "proc/models/sampling.h"

#include <Eigen/Geometry>
#include <cmath>

#include "proc/models/cosine_lobe.h"
#include "proc/models/masking.h"

namespace gonio::proc {
namespace {

Eigen::Vector3d fromPolar(double cosTheta, double sinTheta, double phi) {
    return {sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta};
}

/// About +z, with the density (n + 1) / (2 pi) cos^n.
Eigen::Vector3d powerDirection(double n, const Uniforms& random) {
    const double c = std::pow(1 - random.u, 1 / (n + 1));
    // 1 - c without a difference: u near 0 is the peak of a sharp lobe.
    const double t = -std::expm1(std::log1p(-random.u) / (n + 1));
    return fromPolar(c, std::sqrt(t * (1 + c)), 2 * kPi * random.v);
}

/// What leaves when light from wi meets a facet of this normal, of any length.
Eigen::Vector3d reflected(const Direction& wi, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d n = normal.normalized();
    return 2 * n.dot(wi.vector()) * n - wi.vector();
}

Eigen::Vector3d drawn(const CosineLobe&, const Direction&, const Uniforms& random) {
    return fromPolar(std::sqrt(1 - random.u), std::sqrt(random.u), 2 * kPi * random.v);
}

Eigen::Vector3d drawn(const MirrorPowerLobe& lobe, const Direction& wi, const Uniforms& random) {
    const auto turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), mirrorOf(wi).vector());
    return turn * powerDirection(lobe.n, random);
}

Eigen::Vector3d drawn(const HalfPowerLobe& lobe, const Direction& wi, const Uniforms& random) {
    return reflected(wi, powerDirection(lobe.n, random));
}

// In the space where the ellipsoid of normals is a sphere, the visible hemisphere seen from w is a
// cap about w cut at -w.z: uniform on it, plus w, is a visible normal.
Eigen::Vector3d drawn(const GgxLobe& lobe, const Direction& wi, const Uniforms& random) {
    const Eigen::Vector3d stretch(lobe.alpha.x, lobe.alpha.y, 1);
    const Eigen::Vector3d w = wi.vector().cwiseProduct(stretch).normalized();
    const double z = 1 - random.v * (1 + w.z());
    const double sinTheta = std::sqrt(std::max(0.0, (1 - z) * (1 + z)));
    const Eigen::Vector3d normal = fromPolar(z, sinTheta, 2 * kPi * random.u) + w;
    return reflected(wi, normal.cwiseProduct(stretch));
}

Eigen::Vector3d drawn(const BeckmannLobe& lobe, const Direction& wi, const Uniforms& random) {
    const double slope = std::sqrt(-std::log1p(-random.u));
    const double phi = 2 * kPi * random.v;
    return reflected(
        wi, {slope * lobe.alpha.x * std::cos(phi), slope * lobe.alpha.y * std::sin(phi), 1});
}

Eigen::Vector3d drawn(const Gtr1Lobe& lobe, const Direction& wi, const Uniforms& random) {
    const double a2 = lobe.alpha * lobe.alpha;
    const double cos2 =
        a2 < 1 ? std::expm1((1 - random.u) * std::log(a2)) / (a2 - 1) : 1 - random.u;
    const double c = std::min(1.0, std::sqrt(cos2));
    return reflected(wi, fromPolar(c, std::sqrt((1 - c) * (1 + c)), 2 * kPi * random.v));
}

/// One pair, as the densities see it.
struct Seen {
    Pair<double> pair;
    Half<double> half;

    explicit Seen(const LightView& view) : pair(pairOf<double>(view)), half(pair) {}
    [[nodiscard]] HalfSquares<double> squares() const { return {half.sin2, half.cos2}; }
    /// Of wo, for a density of normals that has D cos(theta_h).
    [[nodiscard]] double ofNormals(double d) const {
        return d * half.cosTheta() / (4 * half.cosDiff);
    }
};

double density(const CosineLobe&, const Seen& seen) { return seen.pair.out.z / kPi; }

double density(const MirrorPowerLobe& lobe, const Seen& seen) {
    const double power = cosinePower<Effort::Reference>(lobe.n, mirrorCosine(seen.pair));
    return (lobe.n + 1) / (2 * kPi) * power;
}

double density(const HalfPowerLobe& lobe, const Seen& seen) {
    const double power = cosinePower<Effort::Reference>(lobe.n, halfCosine(seen.half));
    return (lobe.n + 1) / (2 * kPi) * power / (4 * seen.half.cosDiff);
}

double density(const GgxLobe& lobe, const Seen& seen) {
    // G1 / (4 mu) = 1 / (2 (mu + mu sqrt(1 + slope^2))).
    const double masked = 0.5 / (seen.pair.in.z + ggxRoot(seen.pair.in, lobe.alpha));
    return ggxD(seen.half, lobe.alpha) * masked;
}

double density(const BeckmannLobe& lobe, const Seen& seen) {
    return seen.ofNormals(beckmannD<Effort::Reference>(seen.half, lobe.alpha));
}

double density(const Gtr1Lobe& lobe, const Seen& seen) {
    return seen.ofNormals(gtr1D(seen.squares(), lobe.alpha));
}

double totalWeight(const LobeMixture& mixture) {
    double total = 0;
    for (const WeightedLobe& one : mixture) total += std::max(0.0, one.weight);
    return total;
}

}  // namespace

std::optional<Direction> drawDirection(const LobeMixture& mixture,
                                       const Direction& wi,
                                       const Uniforms& random) {
    double left = random.lobe * totalWeight(mixture);
    const WeightedLobe* chosen = nullptr;
    for (const WeightedLobe& one : mixture) {
        if (!(one.weight > 0)) continue;
        chosen = &one;
        left -= one.weight;
        if (left < 0) break;
    }
    if (chosen == nullptr) return std::nullopt;
    const Eigen::Vector3d wo =
        std::visit([&](const auto& lobe) { return drawn(lobe, wi, random); }, chosen->lobe);
    if (!(wo.z() > 0)) return std::nullopt;
    return Direction::fromVector(wo);
}

double drawDensity(const LobeMixture& mixture, const LightView& pair) {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) return 0;
    const double total = totalWeight(mixture);
    if (!(total > 0)) return 0;
    const Seen seen(pair);
    double sum = 0;
    for (const WeightedLobe& one : mixture) {
        if (!(one.weight > 0)) continue;
        sum += one.weight *
               std::visit([&](const auto& lobe) { return density(lobe, seen); }, one.lobe);
    }
    return sum / total;
}

}  // namespace gonio::proc
