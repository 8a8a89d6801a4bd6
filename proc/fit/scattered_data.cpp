// Scattered values, pair by pair.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "proc/fit/data_maker.h"
#include "proc/formats/flag_column.h"
#include "proc/table/band_channels.h"

namespace gonio::proc {
namespace {

/// Groups of scattered incidences: cut where two neighbours are more than half a degree apart;
/// where that makes more than kMostGroups, neighbouring ones are joined, about as many rows to
/// each.
void groupByIncidence(BrdfData& data) {
    constexpr std::size_t kMostGroups = 12;
    const std::size_t count = data.rows.size();
    std::vector<double> theta(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec<double>& in = data.nodes[data.rows[i].firstNode].pair.in;
        theta[i] = std::atan2(std::hypot(in.x, in.y), in.z);
    }
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return theta[a] < theta[b];
    });
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < count; ++i) {
        const bool apart = i == 0 || theta[order[i]] - theta[order[i - 1]] > (0.5_deg).value();
        if (apart) begins.push_back(i);
    }
    if (begins.size() > kMostGroups) {
        std::vector<std::size_t> joined;
        for (const std::size_t begin : begins) {
            if (begin * kMostGroups >= joined.size() * count) joined.push_back(begin);
        }
        begins = std::move(joined);
    }
    for (std::size_t g = 0; g < begins.size(); ++g) {
        const std::size_t end = g + 1 < begins.size() ? begins[g + 1] : count;
        double sum = 0;
        for (std::size_t i = begins[g]; i < end; ++i) {
            data.rows[order[i]].group = static_cast<std::uint16_t>(g);
            sum += theta[order[i]];
        }
        data.incidences.emplace_back(sum / static_cast<double>(end - begins[g]));
    }
}

}  // namespace

Result<BrdfData> fitDataOf(const BrdfRows& rows, const DataOptions& options) {
    const Result<BandChannels> bands = bandChannels(rows.channels);
    if (!bands) return bands.error();
    DataMaker maker(options);
    maker.data().bands = bands->count;
    maker.data().uKnown = std::any_of(
        rows.uRandom.begin(), rows.uRandom.end(), [](double u) { return !std::isnan(u); });
    for (std::size_t i = 0; i < rows.pairs.size(); ++i) {
        const LightView& pair = rows.pairs[i];
        if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
            maker.leaveOut();
            continue;
        }
        FitRow& row = maker.add(pair);
        for (std::size_t b = 0; b < maker.data().bandsUsed(); ++b) {
            const ChannelBlend& blend = bands->bands[b];
            const auto of = [&](const std::vector<double>& values) {
                return blend.of([&](std::size_t c) { return values[rows.index(i, c)]; });
            };
            if (isLost(rows.flagsAt(i, blend.low) | rows.flagsAt(i, blend.high))) continue;
            row.f[b] = of(rows.f);
            if (!rows.uRandom.empty()) row.uRandom[b] = of(rows.uRandom);
            if (!rows.uSystematic.empty()) row.uSystematic[b] = of(rows.uSystematic);
        }
    }
    groupByIncidence(maker.data());
    return std::move(maker).finished();
}

}  // namespace gonio::proc
