#include "sim/sensor.h"

#include <algorithm>
#include <cmath>

#include "proc/core/parallel.h"
#include "sim/random.h"

namespace gonio::sim {
namespace {

constexpr double kFullWell = 10500;      // e-
constexpr double kReadNoise = 2.4;       // e-
constexpr double kElectronsPerDn = 2.6;  // e-/DN
constexpr double kDarkAt25 = 3;          // e-/s
constexpr double kDoublingKelvin = 7;
constexpr double kNonUniformity = 0.007;
constexpr std::int64_t kOffsetNs = 14'260;  // between the line time and the effective exposure
constexpr std::int64_t kLineNs = 10LL * kExposureStep;

/// The nearest DN. The black level keeps it positive, so that cutting off rounds.
std::uint16_t digitised(double electrons) {
    const double dn = electrons / kElectronsPerDn + kBlackLevel;
    return static_cast<std::uint16_t>(std::clamp(dn, 0.0, double{kFullScale}) + 0.5);
}

}  // namespace

Nanoseconds grantedExposure(std::uint32_t requestedUs) {
    const std::int64_t wanted = 1000LL * requestedUs - kOffsetNs;
    const std::int64_t lines = std::max<std::int64_t>(1, (wanted + kLineNs / 2) / kLineNs);
    return Nanoseconds(lines * kLineNs + kOffsetNs);
}

Sensor::Sensor(const std::string& serial, double celsius) : key_(0x70726E75), celsius_(celsius) {
    for (char c : serial) key_ = mixed(key_, static_cast<unsigned char>(c));
    response_ = Image<float>(kSensorSize);
    parallelFor(response_.pixels().size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            response_.pixels()[i] = static_cast<float>(response(i));
        }
    });
}

double Sensor::response(std::uint64_t pixel) const {
    return 1 + kNonUniformity * gaussian(key_, pixel);
}

Image<std::uint16_t> Sensor::expose(const Image<float>* rate,
                                    double level,
                                    Nanoseconds exposure,
                                    const View& view,
                                    const NoiseKey& key,
                                    int binning) const {
    const double seconds = static_cast<double>(exposure.count()) * 1e-9;
    const double dark = kDarkAt25 * std::exp2((celsius_ - 25) / kDoublingKelvin) * seconds;
    const std::uint64_t shotKey = mixed(mixed(mixed(key.seed, key.planStep), key.frameIndex), 1);
    const std::uint64_t readKey = mixed(shotKey, 2);
    const double gain = level * seconds;
    Image<std::uint16_t> full(view.size);
    parallelFor(static_cast<std::size_t>(view.size.height), [&](IndexRange rows) {
        for (std::size_t y = rows.begin; y < rows.end; ++y) {
            const int row = static_cast<int>(y);
            const auto out = full.row(row);
            const auto left = static_cast<std::size_t>(view.x);
            const auto response = response_.row(view.y + row).subspan(left, out.size());
            const auto sensorRow = static_cast<std::uint64_t>(view.y + row);
            const std::uint64_t firstPixel = sensorRow * response_.row(0).size() + left;
            for (std::size_t x = 0; x < out.size(); ++x) {
                const std::uint64_t pixel = firstPixel + x;
                const double light =
                    rate == nullptr ? 0 : double{rate->row(row)[x]} * gain * double{response[x]};
                const double electrons =
                    std::min(kFullWell, poisson(light + dark, uniform(shotKey, pixel))) +
                    kReadNoise * gaussian(readKey, pixel);
                out[x] = digitised(electrons);
            }
        }
    });
    if (binning == 1) return full;
    Image<std::uint16_t> binned({view.size.width / binning, view.size.height / binning});
    for (int y = 0; y < binned.height(); ++y) {
        for (int x = 0; x < binned.width(); ++x) {
            int sum = 0;
            bool saturated = false;
            for (int j = 0; j < binning; ++j) {
                for (int i = 0; i < binning; ++i) {
                    const int dn = full.at(x * binning + i, y * binning + j);
                    sum += dn;
                    saturated = saturated || dn >= kFullScale;
                }
            }
            const int members = binning * binning;
            binned.at(x, y) =
                saturated ? kFullScale : static_cast<std::uint16_t>((sum + members / 2) / members);
        }
    }
    return binned;
}

}  // namespace gonio::sim
