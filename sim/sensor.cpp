#include "sim/sensor.h"

#include <algorithm>
#include <cmath>

#include "proc/core/parallel.h"
#include "sim/random.h"

namespace gonio::sim {
namespace {

constexpr double kReadNoise = 2.4;          // e-
constexpr std::int64_t kOffsetNs = 14'260;  // between the line time and the effective exposure
constexpr std::int64_t kLineNs = 10LL * kExposureStep;

/// From collected electrons to a DN. Local to a row: what it holds is then not read again for each
/// pixel that is written.
class Converter {
public:
    Converter(const Digits& digits, double nonLinearity)
        : electronsPerDn_(digits.electronsPerDn),
          blackLevel_(digits.blackLevel),
          fullScale_(digits.fullScale),
          bow_(4 * nonLinearity) {}

    /// By how many electrons so many collected ones are read wrong.
    [[nodiscard]] double bow(double electrons) const {
        return bow_ * electrons * (1 - electrons / kFullWell);
    }
    /// The nearest DN. The black level keeps it positive, so that cutting off rounds.
    [[nodiscard]] std::uint16_t digitised(double electrons) const {
        const double dn = electrons / electronsPerDn_ + blackLevel_;
        return static_cast<std::uint16_t>(std::clamp(dn, 0.0, fullScale_) + 0.5);
    }

private:
    double electronsPerDn_;
    double blackLevel_;
    double fullScale_;
    double bow_;
};

/// PROTOCOL.md 2: the mean of the members, or full scale if any is saturated.
Image<std::uint16_t> binned(const Image<std::uint16_t>& full,
                            int binning,
                            std::uint16_t fullScale) {
    Image<std::uint16_t> mean({full.width() / binning, full.height() / binning});
    for (int y = 0; y < mean.height(); ++y) {
        for (int x = 0; x < mean.width(); ++x) {
            int sum = 0;
            bool saturated = false;
            for (int j = 0; j < binning; ++j) {
                for (int i = 0; i < binning; ++i) {
                    const int dn = full.at(x * binning + i, y * binning + j);
                    sum += dn;
                    saturated = saturated || dn >= fullScale;
                }
            }
            const int members = binning * binning;
            mean.at(x, y) =
                saturated ? fullScale : static_cast<std::uint16_t>((sum + members / 2) / members);
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

Digits digitsOf(int bits) {
    const Digits finest;
    const int times = 1 << (finest.bits - bits);
    return {.bits = bits,
            .blackLevel = static_cast<std::uint16_t>((finest.blackLevel + times / 2) / times),
            .fullScale = static_cast<std::uint16_t>((finest.fullScale + 1) / times - 1),
            .electronsPerDn = finest.electronsPerDn * times};
}

Sensor::Sensor(const std::string& serial, const RigErrors& errors)
    : key_(0x70726E75), errors_(errors), digits_(digitsOf(errors.bits)) {
    for (char c : serial) key_ = mixed(key_, static_cast<unsigned char>(c));
    hotKey_ = mixed(key_, 0x686F74);
    rows_ = std::make_shared<std::array<Row, kSensorSize.height>>();
}

const Sensor::Row& Sensor::rowOf(int y) const {
    Row& row = (*rows_)[static_cast<std::size_t>(y)];
    std::call_once(row.made, [&] {
        constexpr auto kWidth = static_cast<std::uint64_t>(kSensorSize.width);
        const std::uint64_t first = static_cast<std::uint64_t>(y) * kWidth;
        row.response.resize(kWidth);
        for (std::uint64_t x = 0; x < kWidth; ++x) {
            row.response[x] = static_cast<float>(response(first + x));
            const double dark = darkCurrent(first + x);
            if (dark > kDarkAt25) row.hot.push_back({first + x, dark});
        }
    });
    return row;
}

double Sensor::response(std::uint64_t pixel) const {
    return 1 + errors_.nonUniformity * gaussian(key_, pixel);
}

double Sensor::darkCurrent(std::uint64_t pixel) const {
    if (uniform(hotKey_, pixel) >= kHotShare) return kDarkAt25;
    return kLeastHotAt25 *
           std::pow(kHottestAt25 / kLeastHotAt25, uniform(mixed(hotKey_, 1), pixel));
}

void Sensor::darkElectrons(const Row& row,
                           double darkTime,
                           std::uint64_t first,
                           std::span<double> out) {
    std::fill(out.begin(), out.end(), kDarkAt25 * darkTime);
    const auto before = [](const HotPixel& hot, std::uint64_t pixel) { return hot.pixel < pixel; };
    for (auto hot = std::lower_bound(row.hot.begin(), row.hot.end(), first, before);
         hot != row.hot.end() && hot->pixel < first + out.size();
         ++hot) {
        out[hot->pixel - first] = hot->darkCurrent * darkTime;
    }
}

std::vector<double> Sensor::columnErrors(const View& view, std::uint64_t shotKey) const {
    std::vector<double> columns(static_cast<std::size_t>(view.size.width));
    const std::uint64_t key = mixed(shotKey, 3);
    for (std::size_t x = 0; x < columns.size(); ++x) {
        columns[x] = errors_.columnNoise * gaussian(key, static_cast<std::uint64_t>(view.x) + x);
    }
    return columns;
}

void Sensor::exposeRow(const Shot& shot,
                       const View& view,
                       int row,
                       std::span<std::uint16_t> out) const {
    const auto left = static_cast<std::size_t>(view.x);
    const Row& own = rowOf(view.y + row);
    const auto response = std::span(own.response).subspan(left, out.size());
    const auto sensorRow = static_cast<std::uint64_t>(view.y + row);
    const std::uint64_t firstPixel = sensorRow * own.response.size() + left;
    std::vector<double> dark(out.size());
    darkElectrons(own, shot.darkTime, firstPixel, dark);
    const auto rate = shot.rate == nullptr ? std::span<const float>() : shot.rate->row(row);
    const Converter converter(digits_, errors_.nonLinearity);
    for (std::size_t x = 0; x < out.size(); ++x) {
        const std::uint64_t pixel = firstPixel + x;
        const double light = rate.empty() ? 0 : double{rate[x]} * shot.gain * double{response[x]};
        const double collected =
            std::min(kFullWell, poisson(light + dark[x], uniform(shot.shotKey, pixel)));
        double electrons = collected + kReadNoise * gaussian(shot.readKey, pixel);
        if (!shot.faithful) electrons += converter.bow(collected) + shot.columns[x];
        out[x] = converter.digitised(electrons);
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
    const bool faithful = errors_.columnNoise == 0 && errors_.nonLinearity == 0;
    const Shot shot{
        .rate = rate,
        .gain = level * seconds,
        .darkTime = std::exp2((errors_.celsius - 25) / errors_.doublingKelvin) * seconds,
        .shotKey = shotKey,
        .readKey = mixed(shotKey, 2),
        .faithful = faithful,
        .columns = faithful ? std::vector<double>() : columnErrors(view, shotKey)};
    Image<std::uint16_t> full(view.size);
    parallelFor(static_cast<std::size_t>(view.size.height), [&](IndexRange rows) {
        for (std::size_t y = rows.begin; y < rows.end; ++y) {
            const int row = static_cast<int>(y);
            exposeRow(shot, view, row, full.row(row));
        }
    });
    return binning == 1 ? full : binned(full, binning, digits_.fullScale);
}

}  // namespace gonio::sim
