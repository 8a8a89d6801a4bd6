#pragma once
// The sensor: 1280 x 1024 mono, 12 bit, full well 10.5 ke-, read noise 2.4 e-, 2.6 e-/DN, black
// level 60 DN, dark current 3 e-/s at 25 degC doubling each 7 K, photo-response non-uniformity 0.7
// % drawn from the serial. Noise is a pure function of (seed, plan step, frame index, pixel).

#include <cstdint>
#include <string>

#include "proc/core/image.h"
#include "proc/core/units.h"

namespace gonio::sim {

inline constexpr Size kSensorSize{1280, 1024};
inline constexpr std::uint16_t kBlackLevel = 60;
inline constexpr std::uint16_t kFullScale = 4095;
inline constexpr std::uint32_t kExposureMinUs = 20;
inline constexpr std::uint32_t kExposureMaxUs = 1'000'000;
inline constexpr std::uint16_t kExposureStep = 550;  ///< 0.01 us: one line

/// The effective exposure that the sensor gives for a request: whole lines plus a fixed 14.26 us.
[[nodiscard]] Nanoseconds grantedExposure(std::uint32_t requestedUs);

/// The part of the sensor that is read, in sensor pixels.
struct View {
    int x = 0, y = 0;
    Size size = kSensorSize;
    bool operator==(const View&) const = default;
};

struct NoiseKey {
    std::uint64_t seed = 0;
    std::uint64_t planStep = 0;
    std::uint64_t frameIndex = 0;
};

class Sensor {
public:
    explicit Sensor(const std::string& serial, double celsius = 25);

    /// One exposure of the view's pixels, whose light is `rate` times `level` in electrons per
    /// second. No rate: dark. Binned as the protocol says.
    [[nodiscard]] Image<std::uint16_t> expose(const Image<float>* rate,
                                              double level,
                                              Nanoseconds exposure,
                                              const View& view,
                                              const NoiseKey& key,
                                              int binning) const;

    /// Gain of a pixel of the sensor relative to the mean: 1 +- 0.7 %.
    [[nodiscard]] double response(std::uint64_t pixel) const;

private:
    std::uint64_t key_;
    double celsius_;
    Image<float> response_;  // of the whole sensor
};

}  // namespace gonio::sim
