#pragma once
// The sensor: 1280 x 1024 mono, 12 bit, full well 10.5 ke-, read noise 2.4 e-, 2.6 e-/DN, black
// level 60 DN, dark current 3 e-/s at 25 degC doubling each 7 K, photo-response non-uniformity 0.7
// % drawn from the serial. Noise is a pure function of (seed, plan step, frame index, pixel).
//
// Its errors (rig_errors.h) change some of this: with fewer bits a DN has as many times the
// electrons and the black level is as much lower, rounded. A non-linear response reads e electrons
// as
//     e + inl F 4 (e / F) (1 - e / F),   F: full well;
// right at e = 0 and e = F, off by inl F at half, steeper by 4 inl near 0. Column noise adds to all
// pixels of a column the same electrons, Gaussian, drawn anew for each frame, before binning.
//
// Hot pixels, drawn from the serial too: one in 5000 has a dark current of 30 to 3000 e-/s at 25
// degC, as many in each octave, and doubling each 7 K as the rest.

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "proc/core/image.h"
#include "proc/core/units.h"
#include "sim/rig_errors.h"

namespace gonio::sim {

inline constexpr Size kSensorSize{1280, 1024};
inline constexpr std::uint16_t kBlackLevel = 60;   ///< DN at 12 bit
inline constexpr std::uint16_t kFullScale = 4095;  ///< DN at 12 bit
inline constexpr double kFullWell = 10500;         ///< e-
inline constexpr double kHotShare = 2e-4;          ///< of the pixels
inline constexpr double kHottestAt25 = 3000;       ///< e-/s
inline constexpr double kLeastHotAt25 = 30;        ///< e-/s
inline constexpr double kDarkAt25 = 3;             ///< e-/s, of all other pixels
inline constexpr std::uint32_t kExposureMinUs = 20;
inline constexpr std::uint32_t kExposureMaxUs = 1'000'000;
inline constexpr std::uint16_t kExposureStep = 550;  ///< 0.01 us: one line

/// The effective exposure that the sensor gives for a request: whole lines plus a fixed 14.26 us.
[[nodiscard]] Nanoseconds grantedExposure(std::uint32_t requestedUs);

/// What the digits of a pixel mean.
struct Digits {
    int bits = 12;
    std::uint16_t blackLevel = kBlackLevel;
    std::uint16_t fullScale = kFullScale;
    double electronsPerDn = 2.6;
};

/// `bits`: 8, 10 or 12.
[[nodiscard]] Digits digitsOf(int bits);

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
    explicit Sensor(const std::string& serial, const RigErrors& errors = {});

    /// One exposure of the view's pixels, whose light is `rate` times `level` in electrons per
    /// second. No rate: dark. Binned as the protocol says.
    [[nodiscard]] Image<std::uint16_t> expose(const Image<float>* rate,
                                              double level,
                                              Nanoseconds exposure,
                                              const View& view,
                                              const NoiseKey& key,
                                              int binning) const;

    /// Gain of a pixel of the sensor relative to the mean: 1 +- its non-uniformity.
    [[nodiscard]] double response(std::uint64_t pixel) const;
    /// Dark current of a pixel of the sensor at 25 degC, e-/s.
    [[nodiscard]] double darkCurrent(std::uint64_t pixel) const;

private:
    struct HotPixel {
        std::uint64_t pixel = 0;
        double darkCurrent = 0;  // at 25 degC
    };
    /// What the pixels of a row are of themselves: made once, where the row is read at all.
    struct Row {
        std::once_flag made;
        std::vector<float> response;
        std::vector<HotPixel> hot;  // by pixel
    };
    /// What one exposure has for all its rows.
    struct Shot {
        const Image<float>* rate = nullptr;
        double gain = 0;      // level times seconds
        double darkTime = 0;  // seconds at 25 degC that give the dark current of the exposure
        std::uint64_t shotKey = 0, readKey = 0;
        bool faithful = true;           // read as it is: no bow, no column is off
        std::vector<double> columns{};  // unless faithful: electrons by which each is off
    };
    [[nodiscard]] std::vector<double> columnErrors(const View& view, std::uint64_t shotKey) const;
    void exposeRow(const Shot& shot, const View& view, int row, std::span<std::uint16_t> out) const;
    /// Mean dark electrons of the row's pixels from `first` on.
    static void darkElectrons(const Row& row,
                              double darkTime,
                              std::uint64_t first,
                              std::span<double> out);

    [[nodiscard]] const Row& rowOf(int y) const;

    std::uint64_t key_;
    std::uint64_t hotKey_;
    RigErrors errors_;
    Digits digits_;
    std::shared_ptr<std::array<Row, kSensorSize.height>>
        rows_;  // shared by copies, as they are one sensor's
};

}  // namespace gonio::sim
