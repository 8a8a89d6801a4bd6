#pragma once
// Frames of a flat scene as the model sensor of noise.h takes them, black level 60 DN.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "proc/core/frame.h"
#include "proc/radiance/dark.h"
#include "proc/radiance/noise.h"

namespace gonio::test {

inline constexpr double kBlackDn = 60;

struct Shot {
    double electronsPerSecond = 0;  ///< of the light, at full level
    double seconds = 1e-3;
    std::uint16_t level = 65535;  ///< 0: a dark frame
};

/// A pixel with a dark current of its own.
struct Hot {
    int x = 0, y = 0;
    double electronsPerSecond = 0;
};

/// What a shot's frame says of itself, without pixels.
inline Frame unexposed(const Shot& shot, Size size) {
    Frame frame;
    frame.pixels = Image<std::uint16_t>(size);
    frame.window = {.size = size};
    frame.exposure = {.requested = {}, .granted = Nanoseconds(std::llround(shot.seconds * 1e9))};
    frame.blackLevel = static_cast<std::uint16_t>(kBlackDn);
    frame.levels = LedLevels::only(Band::G, shot.level);
    if (shot.level > 0) frame.led = 1;
    return frame;
}

/// The reading of one pixel after another that collects `electrons` on average.
class Exposed {
public:
    Exposed(double electrons, const proc::SensorNoise& noise)
        // Far above full scale all pictures are alike; and where the mean does not fit an int, the
        // distribution would look for a number for ever.
        : light_(std::clamp(electrons, 1e-12, 1e6)),
          read_(0, noise.readNoiseElectrons),
          noise_(noise) {}

    std::uint16_t operator()(std::mt19937_64& random) {
        const double dn = kBlackDn + (light_(random) + read_(random)) / noise_.electronsPerDn;
        return static_cast<std::uint16_t>(std::clamp(std::round(dn), 0.0, noise_.fullScaleDn));
    }

private:
    std::poisson_distribution<int> light_;
    std::normal_distribution<double> read_;
    proc::SensorNoise noise_;
};

inline Frame take(const Shot& shot,
                  Size size,
                  std::mt19937_64& random,
                  const std::vector<Hot>& hot = {},
                  const proc::SensorNoise& noise = {}) {
    Frame frame = unexposed(shot, size);
    const double lit = shot.electronsPerSecond * shot.seconds * shot.level / 65535.0;
    Exposed normal(lit + noise.darkElectronsPerSecond * shot.seconds, noise);
    for (std::uint16_t& pixel : frame.pixels.pixels()) pixel = normal(random);
    for (const Hot& h : hot)
        frame.pixels.at(h.x, h.y) =
            Exposed(lit + h.electronsPerSecond * shot.seconds, noise)(random);
    return frame;
}

/// Of a scene that is not flat: `light` in electrons per second at full level.
inline Frame takeScene(const Image<double>& light, const Shot& shot, std::mt19937_64& random) {
    const proc::SensorNoise noise;
    Frame frame = unexposed(shot, light.size());
    const double tau = shot.seconds * shot.level / 65535.0;
    for (std::size_t i = 0; i < light.pixels().size(); ++i) {
        const double dark = noise.darkElectronsPerSecond * shot.seconds;
        frame.pixels.pixels()[i] = Exposed(light.pixels()[i] * tau + dark, noise)(random);
    }
    return frame;
}

/// A lobe over a diffuse floor, 1 : 1e4, as wide as a tenth of the picture.
inline Image<double> lobe(Size size, double peak) {
    Image<double> light(size);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const double u = 10 * (x - 0.6 * size.width) / size.width;
            const double v = 10 * (y - 0.5 * size.height) / size.height;
            light.at(x, y) = peak * (1e-4 + std::pow(1 + u * u + v * v, -2));
        }
    }
    return light;
}

/// Dark frames without noise, of the exposures of the shots: the black level and the mean of the
/// dark current.
inline proc::DarkLibrary perfectDarks(const std::vector<Shot>& shots,
                                      Size size,
                                      const proc::SensorNoise& noise = {}) {
    proc::DarkLibrary library;
    for (const Shot& shot : shots) {
        proc::DarkFrame dark;
        const double dn =
            kBlackDn + noise.darkElectronsPerSecond * shot.seconds / noise.electronsPerDn;
        dark.mean = Image<float>(size, static_cast<float>(dn));
        dark.exposure.granted = Nanoseconds(std::llround(shot.seconds * 1e9));
        dark.window = {.size = size};
        dark.frames = 1;
        library.add(dark);
    }
    return library;
}

/// 1 / sum tau^2 / var over what is not saturated: no unbiased estimate of `light` has a smaller
/// variance.
inline double cramerRao(const std::vector<Shot>& shots, double light) {
    const proc::SensorNoise noise;
    double information = 0;
    for (const Shot& shot : shots) {
        const double tau = shot.seconds * shot.level / 65535.0;
        const double electrons = light * tau;
        if (electrons > (noise.saturationDn() - kBlackDn) * noise.electronsPerDn) continue;
        information += tau * tau / noise.variance(electrons, shot.seconds);
    }
    return 1 / information;
}

/// Seven exposures, 20 us times 1, 8, 64 ...
inline std::vector<Shot> wideLadder() {
    std::vector<Shot> shots;
    for (double seconds = 20e-6; shots.size() < 7; seconds *= 8)
        shots.push_back({.seconds = seconds});
    return shots;
}

}  // namespace gonio::test
