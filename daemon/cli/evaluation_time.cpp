#include "daemon/cli/evaluation_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "proc/models/spec.h"

namespace gonio::daemon {
namespace {

/// Directions over the hemisphere, those of the light and of the view in different orders.
struct SpiralPairs {
    static constexpr std::size_t kCount = 2048;
    static constexpr double kGoldenAngle = 2.399963229728653;
    std::vector<double> inX, inY, inZ, outX, outY, outZ;

    SpiralPairs() {
        const auto count = static_cast<double>(kCount);
        for (std::size_t i = 0; i < kCount; ++i) {
            const auto k = static_cast<double>(i);
            add(1 - (k + 0.5) / count, k * kGoldenAngle, inX, inY, inZ);
            add((k + 0.5) / count, 1.7 * k * kGoldenAngle, outX, outY, outZ);
        }
    }

private:
    static void add(double z,
                    double phi,
                    std::vector<double>& xs,
                    std::vector<double>& ys,
                    std::vector<double>& zs) {
        const double radius = std::sqrt((1 - z) * (1 + z));
        xs.push_back(radius * std::cos(phi));
        ys.push_back(radius * std::sin(phi));
        zs.push_back(z);
    }
};

}  // namespace

std::optional<double> evaluationNanoseconds(const std::string& spec, const Clock& clock) {
    const auto model = proc::makeModel(spec);
    if (!model) return std::nullopt;
    const SpiralPairs pairs;
    std::vector<double> r(SpiralPairs::kCount);
    std::vector<double> g = r;
    std::vector<double> b = r;
    std::array<double, 5> times{};
    for (double& time : times) {
        const Stopwatch watch(clock);
        (*model)->evaluate(proc::PairArrays<double>{.inX = pairs.inX,
                                                    .inY = pairs.inY,
                                                    .inZ = pairs.inZ,
                                                    .outX = pairs.outX,
                                                    .outY = pairs.outY,
                                                    .outZ = pairs.outZ},
                           proc::BandArrays<double>{.r = r, .g = g, .b = b});
        time = 1e9 * watch.elapsed().count() / static_cast<double>(SpiralPairs::kCount);
    }
    std::sort(times.begin(), times.end());
    return times[2];
}

}  // namespace gonio::daemon
