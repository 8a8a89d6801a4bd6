#include "proc/fit/residual_map.h"

#include <cmath>
#include <limits>
#include <optional>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

std::optional<std::size_t> cellOf(const FitRow& row, const BrdfData& data) {
    if (row.cell >= 0) return static_cast<std::size_t>(row.cell);
    const Pair<double>& pair = data.nodes[row.firstNode].pair;
    const auto in = Direction::fromVector({pair.in.x, pair.in.y, pair.in.z});
    const auto out = Direction::fromVector({pair.out.x, pair.out.y, pair.out.z});
    if (!in || !out) return std::nullopt;
    return CellGrid::cellAt(out->turned(Radians(-in->phi().value())));
}

template <class Value>
SampleSet mapOf(const ModelFit& fit, const BrdfData& data, Value&& value) {
    SampleSet set;
    for (const Radians incidence : data.incidences) {
        LedTable led;
        led.incidence = incidence;
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
            led.bands[b] = CellSamples::missing(CellGrid::count());
        }
        set.leds.push_back(std::move(led));
    }
    const auto residuals = normalisedResiduals(fit, data);
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        const FitRow& row = data.rows[i];
        const auto cell = cellOf(row, data);
        if (!cell) continue;
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
            if (!std::isfinite(residuals[i][b])) continue;
            CellSamples& cells = set.leds[row.group].bands[b];
            double& count = cells.nEff[*cell];
            double& mean = cells.f[*cell];
            const double r = value(residuals[i][b]);
            count += 1;
            mean = count == 1 ? r : mean + (r - mean) / count;
            cells.uRandom[*cell] = 1 / std::sqrt(count);
            cells.uSystematic[*cell] = 0;
            cells.flags[*cell] = Flags{Flag::Measured};
        }
    }
    return set;
}

}  // namespace

SampleSet residualMap(const ModelFit& fit, const BrdfData& data) {
    return mapOf(fit, data, [](double r) { return r; });
}

SampleSet residualSizeMap(const ModelFit& fit, const BrdfData& data) {
    return mapOf(fit, data, [](double r) { return std::abs(r); });
}

std::vector<std::array<double, 3>> residualRms(const ModelFit& fit, const BrdfData& data) {
    struct Sum {
        double squares = 0;
        double count = 0;
    };
    std::vector<std::array<Sum, 3>> sums(data.incidences.size());
    const auto residuals = normalisedResiduals(fit, data);
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        for (std::size_t b = 0; b < 3; ++b) {
            if (!std::isfinite(residuals[i][b])) continue;
            Sum& sum = sums[data.rows[i].group][b];
            sum.squares += residuals[i][b] * residuals[i][b];
            sum.count += 1;
        }
    }
    std::vector<std::array<double, 3>> rms;
    for (const auto& bands : sums) {
        const auto of = [](const Sum& sum) {
            return sum.count > 0 ? std::sqrt(sum.squares / sum.count)
                                 : std::numeric_limits<double>::quiet_NaN();
        };
        rms.push_back({of(bands[0]), of(bands[1]), of(bands[2])});
    }
    return rms;
}

}  // namespace gonio::proc
