#include "sim/camera.h"

#include <algorithm>
#include <utility>

namespace gonio::sim {
namespace {

constexpr double kFullLevel = 65535;

bool isLit(std::uint16_t level) { return level != 0; }

/// All bands together, each so much of its full light.
Image<float> added(const RateImages& images, const LedBands& light) {
    Image<float> sum(images[0].size());
    for (std::size_t c = 0; c < 3; ++c) {
        const auto share = static_cast<float>(light.value[c]);
        for (std::size_t i = 0; i < sum.pixels().size(); ++i) {
            sum.pixels()[i] += share * images[c].pixels()[i];
        }
    }
    return sum;
}

}  // namespace

Camera::Camera(const std::string& serial, ReferenceErrors errors, double sensorCelsius)
    : errors_(errors),
      // The window that the host reads is centred on the sensor; so is the lens, up to its offset.
      optics_(serial, {kSensorSize.width / 2.0, kSensorSize.height / 2.0}),
      sensor_(serial, sensorCelsius) {}

void Camera::place(Placement placement) {
    placement_ = std::move(placement);
    rates_.clear();
}

const RateImages& Camera::rates(int led, const View& view) {
    if (!field_ || field_->view() != view) {
        rates_.clear();
        field_.emplace(optics_, view);
    }
    const auto found = rates_.find(led);
    if (found != rates_.end()) return found->second;
    return rates_.emplace(led, rateImages(placement_, errors_, optics_, *field_, led))
        .first->second;
}

Image<std::uint16_t> Camera::expose(const Settings& s,
                                    const LedBands& output,
                                    const Format& format,
                                    const NoiseKey& key) {
    const auto expose = [&](const Image<float>* rate, double level) {
        return sensor_.expose(
            rate, level, grantedExposure(s.exposureUs), format.view, key, format.binning);
    };
    if (s.led < 0) return expose(nullptr, 1);
    const RateImages& images = rates(s.led, format.view);
    LedBands light;
    for (Band b : kBands) light[b] = s.levels[index(b)] / kFullLevel * output[b];
    // One band is lit at a time in a measurement; several together add their light.
    if (std::count_if(s.levels.begin(), s.levels.end(), isLit) == 1) {
        const auto lit = std::find_if(s.levels.begin(), s.levels.end(), isLit);
        const auto band = static_cast<std::size_t>(lit - s.levels.begin());
        return expose(&images[band], light.value[band]);
    }
    const Image<float> sum = added(images, light);
    return expose(&sum, 1);
}

}  // namespace gonio::sim
