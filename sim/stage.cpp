#include "sim/stage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "proc/core/parallel.h"

namespace gonio::sim {
namespace {

constexpr double kSourceRadius = 0.5 * kPi / 180;
constexpr double kMirrorReflectance = 0.9;
constexpr int kDiscSamples = 4;  // per pixel side, at the disc's edge

double orZero(double f) { return std::isfinite(f) ? f : 0; }

/// The factors on the surface's f that its certificate does not know.
struct SurfaceErrors {
    SurfaceErrors(const Placement& placement, const ReferenceErrors& errors, int led) {
        if (placement.role == Role::White) white = errors.white(led);
        if (placement.role == Role::Black) black = errors.black();
    }
    WhiteErrors white;
    double black = 1;
};

/// f cos(theta_o) of the placement in one direction, per band.
LedBands surfaceLight(const Placement& placement,
                      const SurfaceErrors& errors,
                      int led,
                      const Direction& wo) {
    if (placement.surface == nullptr) return {};
    const Answer answer = placement.surface->answer({.in = ledDirection(led), .out = wo});
    const LedBands white = errors.white.factor(wo);
    LedBands light;
    for (Band b : kBands) light[b] = orZero(answer.f[b]) * wo.z() * white[b] * errors.black;
    return light;
}

/// The share of the pixel that the mirror image of the source covers.
double discShare(const Optics& optics, ImagePoint corner, const Direction& image) {
    int inside = 0;
    for (int i = 0; i < kDiscSamples; ++i) {
        for (int j = 0; j < kDiscSamples; ++j) {
            const auto wo = optics.directionAt(
                {corner.x + (i + 0.5) / kDiscSamples, corner.y + (j + 0.5) / kDiscSamples});
            if (wo && angleBetween({image, *wo}).value() <= kSourceRadius) ++inside;
        }
    }
    return static_cast<double>(inside) / (kDiscSamples * kDiscSamples);
}

double mirrorLight(const Optics& optics,
                   ImagePoint corner,
                   const Direction& wo,
                   const Direction& image) {
    static const double nearby = std::cos(2 * kSourceRadius);
    if (wo.vector().dot(image.vector()) < nearby) return 0;
    // f cos(theta_o) = reflectance / solid angle of the source.
    const double peak = kMirrorReflectance / (kPi * kSourceRadius * kSourceRadius);
    return peak * discShare(optics, corner, image);
}

}  // namespace

Direction mirrored(const Direction& light, const Wedge& wedge) {
    const Eigen::Vector3d normal =
        Eigen::AngleAxisd(wedge.aboutY.value(), Eigen::Vector3d::UnitY()) *
        (Eigen::AngleAxisd(wedge.aboutX.value(), Eigen::Vector3d::UnitX()) *
         Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d& wi = light.vector();
    return *Direction::fromVector(2 * normal.dot(wi) * normal - wi);
}

FieldOfView::FieldOfView(const Optics& optics, const View& view)
    : view_(view), directions_(view.size), transmission_(view.size) {
    parallelFor(static_cast<std::size_t>(view.size.height), [&](IndexRange rows) {
        for (std::size_t row = rows.begin; row < rows.end; ++row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < view.size.width; ++x) {
                const auto wo = optics.directionAt({view.x + x + 0.5, view.y + y + 0.5});
                if (!wo) continue;
                directions_.at(x, y) = *wo;
                transmission_.at(x, y) =
                    static_cast<float>(optics.relativeSolidAngle(*wo) * optics.vignetting(*wo));
            }
        }
    });
}

RateImages rateImages(const Placement& placement,
                      const ReferenceErrors& errors,
                      const Optics& optics,
                      const FieldOfView& field,
                      int led) {
    const View& view = field.view();
    RateImages images{Image<float>(view.size), Image<float>(view.size), Image<float>(view.size)};
    const Direction image = mirrored(ledDirection(led), placement.wedge);
    const SurfaceErrors surfaceErrors(placement, errors, led);
    parallelFor(static_cast<std::size_t>(view.size.height), [&](IndexRange rows) {
        for (std::size_t row = rows.begin; row < rows.end; ++row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < view.size.width; ++x) {
                const double lens = field.transmission(x, y);
                if (lens == 0) continue;
                const Direction& wo = field.direction(x, y);
                LedBands light = surfaceLight(placement, surfaceErrors, led, wo);
                if (placement.role == Role::Mirror) {
                    const ImagePoint corner{double(view.x + x), double(view.y + y)};
                    light = LedBands::all(mirrorLight(optics, corner, wo, image));
                }
                const double stray = strayLight(led, wo);
                for (Band b : kBands) {
                    images[index(b)].at(x, y) =
                        static_cast<float>(ledRate(led, b) * lens * (light[b] + stray));
                }
            }
        }
    });
    return images;
}

}  // namespace gonio::sim
