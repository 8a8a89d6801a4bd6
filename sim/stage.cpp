#include "sim/stage.h"

#include <cmath>

#include "proc/core/parallel.h"
#include "sim/surface_light.h"

namespace gonio::sim {
namespace {

constexpr Radians kPointsDisc = 0.5_deg;  // radius in which a mirror shows a point source
constexpr double kMirrorReflectance = 0.9;
constexpr int kDiscSamples = 4;  // per pixel side, at the disc's edge

/// What a mirror shows of an LED.
class MirrorImage {
public:
    MirrorImage(const Wedge& wedge, Radians sourceDiameter, int led)
        : centre_(mirrored(ledDirection(led), wedge)),
          radius_(sourceDiameter > Radians() ? sourceDiameter / 2 : kPointsDisc),
          nearby_(cos(radius_ * 2)) {}

    /// f cos(theta_o) of the pixel with this corner and this direction of its middle.
    [[nodiscard]] double light(const Optics& optics, ImagePoint corner, const Direction& wo) const {
        if (wo.vector().dot(centre_.vector()) < nearby_) return 0;
        // f cos(theta_o) = reflectance / solid angle of the source.
        const double peak = kMirrorReflectance / (kPi * radius_.value() * radius_.value());
        return peak * share(optics, corner);
    }

private:
    /// The share of the pixel that the image covers.
    [[nodiscard]] double share(const Optics& optics, ImagePoint corner) const {
        int inside = 0;
        for (int i = 0; i < kDiscSamples; ++i) {
            for (int j = 0; j < kDiscSamples; ++j) {
                const auto wo = optics.directionAt(
                    {corner.x + (i + 0.5) / kDiscSamples, corner.y + (j + 0.5) / kDiscSamples});
                if (wo && angleBetween({centre_, *wo}) <= radius_) ++inside;
            }
        }
        return static_cast<double>(inside) / (kDiscSamples * kDiscSamples);
    }

    Direction centre_;
    Radians radius_;
    double nearby_;
};

RateImages darkness(Size size) {
    return {Image<float>(size), Image<float>(size), Image<float>(size)};
}

}  // namespace

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

LedLight ledLight(const Placement& placement,
                  const Flaws& flaws,
                  const Optics& optics,
                  const FieldOfView& field,
                  int led) {
    const View& view = field.view();
    const bool soft = placement.role == Role::Sample && placement.errors.softness > 0;
    LedLight images{.steady = darkness(view.size), .lobe = darkness(soft ? view.size : Size{})};
    const MirrorImage image(
        asGround(placement.wedge, flaws.seed, flaws.rig.wedges), flaws.rig.sourceDiameter, led);
    const SurfaceLight surface(placement, flaws, led);
    parallelFor(static_cast<std::size_t>(view.size.height), [&](IndexRange rows) {
        for (std::size_t row = rows.begin; row < rows.end; ++row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < view.size.width; ++x) {
                const double lens = field.transmission(x, y);
                if (lens == 0) continue;
                const Direction& wo = field.direction(x, y);
                LedBands light = surface.towards(wo);
                if (placement.role == Role::Mirror) {
                    const ImagePoint corner{double(view.x + x), double(view.y + y)};
                    light = LedBands::all(image.light(optics, corner, wo));
                }
                const double stray = strayLight(led, wo);
                const double lobe = soft ? surface.lobeShapeAt(wo) : 0;
                for (Band b : kBands) {
                    const double rate = ledRate(led, b) * lens;
                    images.steady[index(b)].at(x, y) =
                        static_cast<float>(rate * (light[b] + stray));
                    if (soft)
                        images.lobe[index(b)].at(x, y) = static_cast<float>(rate * light[b] * lobe);
                }
            }
        }
    });
    return images;
}

Image<float> ambientLight(const SampleErrors& errors, const FieldOfView& field) {
    const Size size = field.view().size;
    Image<float> image(size);
    const double middle = errors.ambient * ledRate(0, Band::G);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const double lens = field.transmission(x, y);
            if (lens == 0) continue;
            image.at(x, y) =
                static_cast<float>(middle * lens * (1 + field.direction(x, y).y() / 2));
        }
    }
    return image;
}

}  // namespace gonio::sim
