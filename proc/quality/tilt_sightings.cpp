#include "proc/quality/tilt_sightings.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/models/ggx.h"
#include "proc/optics/cell_grid.h"
#include "proc/quality/cell_points.h"

namespace gonio::proc {
namespace {

// Of an LED's cells: those whose f is at least this share of the brightest are its lobe, and some
// others hold the floor; of either at most so many, evenly.
constexpr double kLobeShare = 0.4;
constexpr std::size_t kMostLobeCells = 800, kMostFloorCells = 200;
constexpr Radians kOutermost = 72_deg;  // beyond, cells are cut and f is steep
// A fitted lobe is not the real one: by about so much of its peak, anywhere. By a share of each
// cell's own f, the floor of a lobe that is no GGX would decide the fit.
constexpr double kModelError = 0.02;
// A narrower lobe is another in the middle of a cell than over all of it, by more than 1 %.
constexpr double kNarrowLobe = 0.06;

std::optional<Sighting> sightingAt(const LedTable& led, std::size_t cell) {
    Sighting one{.wi = Direction::fromSpherical(led.incidence, Radians(0)),
                 .wo = CellGrid::centre(cell),
                 .cell = cell};
    if (one.wo.theta() > kOutermost) return std::nullopt;
    int bands = 0;
    for (const CellSamples& band : led.bands) {
        if (band.size() == 0) continue;
        if (!band.present(cell)) return std::nullopt;
        one.f += band.f[cell];
        one.u = std::hypot(one.u, band.uRandom[cell]);
        ++bands;
    }
    if (bands == 0) return std::nullopt;
    one.f /= bands;
    one.u /= bands;
    return one;
}

/// At most `most` of them, evenly.
void thin(std::vector<Sighting>& sightings, std::size_t most) {
    const std::size_t stride = (sightings.size() + most - 1) / most;
    if (stride < 2) return;
    for (std::size_t i = 0; i * stride < sightings.size(); ++i) {
        sightings[i] = sightings[i * stride];
    }
    sightings.resize((sightings.size() + stride - 1) / stride);
}

/// The mean over the cell.
Parts partsOver(const Shape& shape, const Eigen::Matrix3d& turn, const Sighting& one) {
    const std::array<Direction, 4> points = pointsOver(one.cell);
    Parts mean;
    for (const Direction& wo : points) {
        const Parts parts = partsOf(shape, turn, {one.wi, wo});
        mean.floor += parts.floor / points.size();
        mean.lobe += parts.lobe / points.size();
    }
    return mean;
}

/// How strong floor and lobe are under one LED: linear least squares.
TiltLobe strengths(std::span<const Sighting> sightings,
                   const Shape& shape,
                   std::span<const Parts> parts) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < sightings.size(); ++i) {
        const Sighting& one = sightings[i];
        const Eigen::Vector2d row = Eigen::Vector2d(parts[i].floor, parts[i].lobe) / one.sigma;
        normal += row * row.transpose();
        right += row * (one.f / one.sigma);
    }
    const Eigen::Vector2d found = normal.completeOrthogonalDecomposition().solve(right);
    return {.diffuse = std::max(0.0, found[0]),
            .specular = std::max(0.0, found[1]),
            .alpha = shape.alpha,
            .f0 = shape.f0};
}

}  // namespace

Eigen::Matrix3d toSurface(const Direction& normal) {
    return Eigen::Quaterniond::FromTwoVectors(normal.vector(), Eigen::Vector3d::UnitZ())
        .toRotationMatrix();
}

Parts partsOf(const Shape& shape, const Eigen::Matrix3d& turn, const LightView& pair) {
    const Eigen::Vector3d wi = turn * pair.in.vector(), wo = turn * pair.out.vector();
    if (wi.z() <= 0 || wo.z() <= 0) return {};
    const auto alpha = Alpha<double>::isotropic(shape.alpha);
    const Pair<double> own{{wi.x(), wi.y(), wi.z()}, {wo.x(), wo.y(), wo.z()}};
    const Half<double> half(own);
    const double view = wo.z() / pair.out.z();
    return {view / kPi,
            view * ggxD(half, alpha) * ggxV(own, alpha, Masking::HeightCorrelated) *
                schlick(shape.f0, 1.0, half.cosDiff)};
}

Sightings sightingsOf(const LedTable& led) {
    Sightings all;
    double brightest = 0;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        const auto one = sightingAt(led, cell);
        if (!one) continue;
        all.push_back(*one);
        brightest = std::max(brightest, one->f);
    }
    for (Sighting& one : all) {
        const double modelError = kModelError * brightest;
        one.sigma = std::max(std::hypot(one.u, modelError), std::numeric_limits<double>::min());
        one.inLobe = one.f >= kLobeShare * brightest;
    }
    const auto floor = std::stable_partition(
        all.begin(), all.end(), [](const Sighting& one) { return one.inLobe; });
    Sightings others(floor, all.end());
    all.erase(floor, all.end());
    thin(all, kMostLobeCells);
    thin(others, kMostFloorCells);
    all.insert(all.end(), others.begin(), others.end());
    return all;
}

/// Floor and lobe as each sighting shows them.
std::vector<Parts> partsOf(std::span<const Sighting> sightings,
                           const Shape& shape,
                           const Eigen::Matrix3d& turn) {
    std::vector<Parts> parts;
    parts.reserve(sightings.size());
    for (const Sighting& one : sightings) {
        parts.push_back(shape.alpha < kNarrowLobe ? partsOver(shape, turn, one)
                                                  : partsOf(shape, turn, {one.wi, one.wo}));
    }
    return parts;
}

TiltLobe strengths(std::span<const Sighting> sightings,
                   const Shape& shape,
                   const Eigen::Matrix3d& turn) {
    return strengths(sightings, shape, partsOf(sightings, shape, turn));
}

double shownBy(const TiltLobe& lobe, const Parts& parts) {
    return lobe.diffuse * parts.floor + lobe.specular * parts.lobe;
}

double shownBy(const TiltLobe& lobe, const Eigen::Matrix3d& turn, const LightView& pair) {
    return shownBy(lobe, partsOf({lobe.alpha, lobe.f0}, turn, pair));
}

/// (measured - fitted) over what that may be, of one LED.
void residualsOf(std::span<const Sighting> sightings,
                 const Shape& shape,
                 const Direction& normal,
                 std::span<double> out) {
    const std::vector<Parts> parts = partsOf(sightings, shape, toSurface(normal));
    const TiltLobe lobe = strengths(sightings, shape, parts);
    for (std::size_t i = 0; i < sightings.size(); ++i) {
        out[i] = (sightings[i].f - shownBy(lobe, parts[i])) / sightings[i].sigma;
    }
}

}  // namespace gonio::proc
