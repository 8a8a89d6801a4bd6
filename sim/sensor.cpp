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
constexpr double kDoublingKelvin = 7;
constexpr double kNonUniformity = 0.007;
constexpr std::int64_t kOffsetNs = 14'260;  // between the line time and the effective exposure
constexpr std::int64_t kLineNs = 10LL * kExposureStep;

/// The nearest DN. The black level keeps it positive, so that cutting off rounds.
std::uint16_t digitised(double electrons) {
    const double dn = electrons / kElectronsPerDn + kBlackLevel;
    return static_cast<std::uint16_t>(std::clamp(dn, 0.0, double{kFullScale}) + 0.5);
}

/// PROTOCOL.md 2: the mean of the members, or full scale if any is saturated.
Image<std::uint16_t> binned(const Image<std::uint16_t>& full, int binning) {
    Image<std::uint16_t> mean({full.width() / binning, full.height() / binning});
    for (int y = 0; y < mean.height(); ++y) {
        for (int x = 0; x < mean.width(); ++x) {
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
            mean.at(x, y) =
                saturated ? kFullScale : static_cast<std::uint16_t>((sum + members / 2) / members);
        }
    }
    return mean;
}

}  // namespace

Nanoseconds grantedExposure(std::uint32_t requestedUs) {
    const std::int64_t wanted = 1000LL * requestedUs - kOffsetNs;
    const std::int64_t lines = std::max<std::int64_t>(1, (wanted + kLineNs / 2) / kLineNs);
    return Nanoseconds(lines * kLineNs + kOffsetNs);
}

Sensor::Sensor(const std::string& serial, double celsius) : key_(0x70726E75), celsius_(celsius) {
    for (char c : serial) key_ = mixed(key_, static_cast<unsigned char>(c));
    hotKey_ = mixed(key_, 0x686F74);
    response_ = Image<float>(kSensorSize);
    parallelFor(response_.pixels().size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            response_.pixels()[i] = static_cast<float>(response(i));
        }
    });
    for (std::uint64_t pixel = 0; pixel < response_.pixels().size(); ++pixel) {
        const double dark = darkCurrent(pixel);
        if (dark > kDarkAt25) hot_.push_back({pixel, dark});
    }
}

double Sensor::response(std::uint64_t pixel) const {
    return 1 + kNonUniformity * gaussian(key_, pixel);
}

double Sensor::darkCurrent(std::uint64_t pixel) const {
    if (uniform(hotKey_, pixel) >= kHotShare) return kDarkAt25;
    return kLeastHotAt25 *
           std::pow(kHottestAt25 / kLeastHotAt25, uniform(mixed(hotKey_, 1), pixel));
}

void Sensor::darkElectrons(double darkTime, std::uint64_t first, std::span<double> out) const {
    std::fill(out.begin(), out.end(), kDarkAt25 * darkTime);
    const auto before = [](const HotPixel& hot, std::uint64_t pixel) { return hot.pixel < pixel; };
    for (auto hot = std::lower_bound(hot_.begin(), hot_.end(), first, before);
         hot != hot_.end() && hot->pixel < first + out.size();
         ++hot) {
        out[hot->pixel - first] = hot->darkCurrent * darkTime;
    }
}

void Sensor::exposeRow(const Shot& shot,
                       const View& view,
                       int row,
                       std::span<std::uint16_t> out) const {
    const auto left = static_cast<std::size_t>(view.x);
    const auto response = response_.row(view.y + row).subspan(left, out.size());
    const auto sensorRow = static_cast<std::uint64_t>(view.y + row);
    const std::uint64_t firstPixel = sensorRow * response_.row(0).size() + left;
    std::vector<double> dark(out.size());
    darkElectrons(shot.darkTime, firstPixel, dark);
    for (std::size_t x = 0; x < out.size(); ++x) {
        const std::uint64_t pixel = firstPixel + x;
        const double light = shot.rate == nullptr
                                 ? 0
                                 : double{shot.rate->row(row)[x]} * shot.gain * double{response[x]};
        const double electrons =
            std::min(kFullWell, poisson(light + dark[x], uniform(shot.shotKey, pixel))) +
            kReadNoise * gaussian(shot.readKey, pixel);
        out[x] = digitised(electrons);
    }
}

Image<std::uint16_t> Sensor::expose(const Image<float>* rate,
                                    double level,
                                    Nanoseconds exposure,
                                    const View& view,
                                    const NoiseKey& key,
                                    int binning) const {
    const double seconds = static_cast<double>(exposure.count()) * 1e-9;
    const std::uint64_t shotKey = mixed(mixed(mixed(key.seed, key.planStep), key.frameIndex), 1);
    const Shot shot{.rate = rate,
                    .gain = level * seconds,
                    .darkTime = std::exp2((celsius_ - 25) / kDoublingKelvin) * seconds,
                    .shotKey = shotKey,
                    .readKey = mixed(shotKey, 2)};
    Image<std::uint16_t> full(view.size);
    parallelFor(static_cast<std::size_t>(view.size.height), [&](IndexRange rows) {
        for (std::size_t y = rows.begin; y < rows.end; ++y) {
            const int row = static_cast<int>(y);
            exposeRow(shot, view, row, full.row(row));
        }
    });
    return binning == 1 ? full : binned(full, binning);
}

}  // namespace gonio::sim
