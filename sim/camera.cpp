#include "sim/camera.h"

#include <algorithm>
#include <utility>

#include "sim/glare.h"

namespace gonio::sim {
namespace {

constexpr double kFullLevel = 65535;

bool isLit(std::uint16_t level) { return level != 0; }

bool oneBandIsLit(const Settings& s) {
    return std::count_if(s.levels.begin(), s.levels.end(), isLit) == 1;
}

/// Of the bands, relative to their nominal full light.
LedBands lightOf(const Settings& s, const LedBands& output) {
    LedBands light;
    for (Band b : kBands) light[b] = s.levels[index(b)] / kFullLevel * output[b];
    return light;
}

void addTo(Image<float>& sum, const Image<float>& image, double factor) {
    const auto share = static_cast<float>(factor);
    for (std::size_t i = 0; i < sum.pixels().size(); ++i) {
        sum.pixels()[i] += share * image.pixels()[i];
    }
}

/// The part of an image of the whole sensor that a view shows.
Image<float> cropped(const Image<float>& whole, const View& view) {
    Image<float> part(view.size);
    for (int y = 0; y < view.size.height; ++y) {
        const auto row = whole.row(view.y + y)
                             .subspan(static_cast<std::size_t>(view.x),
                                      static_cast<std::size_t>(view.size.width));
        std::copy(row.begin(), row.end(), part.row(y).begin());
    }
    return part;
}

RateImages cropped(const RateImages& whole, const View& view) {
    return {cropped(whole[0], view), cropped(whole[1], view), cropped(whole[2], view)};
}

}  // namespace

Camera::Camera(const std::string& serial, const Flaws& flaws)
    : flaws_(flaws),
      // The window that the host reads is centred on the sensor; so is the lens, up to its offset.
      optics_(serial, {kSensorSize.width / 2.0, kSensorSize.height / 2.0}),
      sensor_(serial, flaws.rig) {}

void Camera::place(Placement placement) {
    placement_ = std::move(placement);
    lights_.clear();
}

void Camera::look(const View& view) {
    if (field_ && field_->view() == view) return;
    lights_.clear();
    field_.emplace(optics_, view);
}

const LedLight& Camera::light(int led) {
    const auto found = lights_.find(led);
    if (found != lights_.end()) return found->second;
    LedLight made = flaws_.rig.glare > 0 ? lightWithGlare(led)
                                         : ledLight(placement_, flaws_, optics_, *field_, led);
    return lights_.emplace(led, std::move(made)).first->second;
}

/// Glare comes from the whole field, whatever the view shows of it.
LedLight Camera::lightWithGlare(int led) {
    if (!whole_) whole_.emplace(optics_, View{});
    const LedLight sharp = ledLight(placement_, flaws_, optics_, *whole_, led);
    const auto seen = [&](const RateImages& images) {
        return cropped(withGlare(images, *whole_, flaws_.rig.glare), field_->view());
    };
    return {.steady = seen(sharp.steady),
            .lobe = sharp.lobe[0].empty() ? RateImages{} : seen(sharp.lobe)};
}

/// All bands together, and what a sample adds: light that leaks in, and the lobe of a pressed one.
Image<float> Camera::sumOfLight(const Settings& s, const Moment& moment) {
    Image<float> sum(field_->view().size);
    if (s.led >= 0) {
        const LedLight& images = light(s.led);
        const LedBands share = lightOf(s, moment.output);
        const double excess = pressed(placement_.errors, moment.sincePlaced);
        for (std::size_t c = 0; c < 3; ++c) {
            addTo(sum, images.steady[c], share.value[c]);
            if (!images.lobe[c].empty()) addTo(sum, images.lobe[c], share.value[c] * excess);
        }
    }
    if (leaks()) addTo(sum, ambientLight(placement_.errors, *field_), 1);
    return sum;
}

Image<std::uint16_t> Camera::expose(const Settings& s,
                                    const Moment& moment,
                                    const Format& format,
                                    const NoiseKey& key) {
    const auto expose = [&](const Image<float>* rate, double level) {
        const Nanoseconds lasts = grantedExposure(s.exposureUs) + flaws_.rig.exposureOffset;
        return sensor_.expose(rate, level, lasts, format.view, key, format.binning);
    };
    if (s.led < 0 && !leaks()) return expose(nullptr, 1);
    look(format.view);
    // One band is lit at a time in a measurement; several together add their light.
    if (s.led >= 0 && !leaks() && oneBandIsLit(s) && light(s.led).lobe[0].empty()) {
        const auto lit = std::find_if(s.levels.begin(), s.levels.end(), isLit);
        const auto band = static_cast<std::size_t>(lit - s.levels.begin());
        return expose(&light(s.led).steady[band], lightOf(s, moment.output).value[band]);
    }
    const Image<float> sum = sumOfLight(s, moment);
    return expose(&sum, 1);
}

}  // namespace gonio::sim
