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

inline Frame take(const Shot& shot,
                  Size size,
                  std::mt19937_64& random,
                  const std::vector<Hot>& hot = {}) {
    const proc::SensorNoise noise;
    Frame frame;
    frame.pixels = Image<std::uint16_t>(size);
    frame.window = {.size = size};
    frame.exposure = {.requested = {}, .granted = Nanoseconds(std::llround(shot.seconds * 1e9))};
    frame.blackLevel = static_cast<std::uint16_t>(kBlackDn);
    frame.levels = LedLevels::only(Band::G, shot.level);
    if (shot.level > 0) frame.led = 1;
    const double lit = shot.electronsPerSecond * shot.seconds * shot.level / 65535.0;
    std::normal_distribution<double> read(0, noise.readNoiseElectrons);
    const auto exposed = [&](double darkPerSecond) {
        // Far above full scale all pictures are alike; and where the mean does not fit an int, the
        // distribution would look for a number for ever.
        std::poisson_distribution<int> light(
            std::clamp(lit + darkPerSecond * shot.seconds, 1e-12, 1e6));
        return [&read, &random, &noise, light]() mutable {
            const double dn = kBlackDn + (light(random) + read(random)) / noise.electronsPerDn;
            return static_cast<std::uint16_t>(std::clamp(std::round(dn), 0.0, noise.fullScaleDn));
        };
    };
    auto normal = exposed(noise.darkElectronsPerSecond);
    for (std::uint16_t& pixel : frame.pixels.pixels()) pixel = normal();
    for (const Hot& h : hot) frame.pixels.at(h.x, h.y) = exposed(h.electronsPerSecond)();
    return frame;
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

}  // namespace gonio::test
