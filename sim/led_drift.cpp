#include "sim/led_drift.h"

#include <cmath>

#include "sim/random.h"

namespace gonio::sim {
namespace {

constexpr double kWarmUpSeconds = 2;
constexpr std::array<double, 3> kHeatLoss{2, 0.5, 0.5};
constexpr double kFullLevel = 65535;
constexpr std::uint64_t kStepsPerNode = 64;

}  // namespace

void LedDrift::run(const Settings& settings, Nanoseconds time) {
    const double seconds = static_cast<double>(time.count()) * 1e-9;
    double level = 0;
    if (settings.led >= 0)
        for (const Band b : kBands) level += settings.levels[index(b)] / kFullLevel;
    heat_ = level + (heat_ - level) * std::exp(-seconds / kWarmUpSeconds);
}

double LedDrift::boardKelvin() const {
    constexpr double kKelvin = 3;
    return kKelvin * heat_;
}

double LedDrift::wander(int led, Band band, std::uint64_t planStep) const {
    const auto stream = static_cast<std::uint64_t>(led) * 3 + index(band);
    const std::uint64_t key = mixed(mixed(seed_, 0x64726966), stream);
    const std::uint64_t node = planStep / kStepsPerNode;
    const double share =
        static_cast<double>(planStep % kStepsPerNode) / static_cast<double>(kStepsPerNode);
    const double between = (1 - share) * gaussian(key, node) + share * gaussian(key, node + 1);
    return between / std::hypot(1 - share, share);  // as wide between the nodes as at them
}

LedBands LedDrift::output(int led, std::uint64_t planStep) const {
    LedBands output;
    for (Band b : kBands) {
        output[b] = 1 + size_ * (wander(led, b, planStep) - kHeatLoss[index(b)] * heat_);
    }
    return planStep < step_.planStep ? output : output * (1 + step_.size);
}

}  // namespace gonio::sim
