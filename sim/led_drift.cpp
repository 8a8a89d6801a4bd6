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
    const double left = std::exp(-seconds / kWarmUpSeconds);
    for (int led = 0; led < kLeds; ++led) {
        LedBands& heat = heat_[static_cast<std::size_t>(led)];
        for (Band b : kBands) {
            const double level = led == settings.led ? settings.levels[index(b)] / kFullLevel : 0;
            heat[b] = level + (heat[b] - level) * left;
        }
    }
}

double LedDrift::heat(int led, Band band) const {
    return heat_[static_cast<std::size_t>(led)][band];
}

double LedDrift::boardKelvin() const {
    constexpr double kKelvin = 3;
    double sum = 0;
    for (const LedBands& led : heat_)
        for (const Band band : kBands) sum += led[band];
    return kKelvin * sum;
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
        output[b] = 1 + size_ * (wander(led, b, planStep) - kHeatLoss[index(b)] * heat(led, b));
    }
    return planStep < step_.planStep ? output : output * (1 + step_.size);
}

}  // namespace gonio::sim
