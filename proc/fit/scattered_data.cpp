// Rows of scattered values in the columns of a CSV.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "proc/core/number_text.h"
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

bool hasColumn(const Points& points, const std::string& name) {
    return std::find(points.columns.begin(), points.columns.end(), name) != points.columns.end();
}

/// The columns NAME or NAME_r, NAME_g, NAME_b; empty where they are not there.
Result<std::vector<std::vector<double>>> bandColumns(const Points& points,
                                                     const std::string& name,
                                                     BandCount bands) {
    std::vector<std::string> names{name};
    if (bands == BandCount::Three) names = {name + "_r", name + "_g", name + "_b"};
    std::vector<std::vector<double>> columns;
    for (const std::string& one : names) {
        if (!hasColumn(points, one)) return std::vector<std::vector<double>>{};
        Result<std::vector<double>> numbers = numbersOf(points, one);
        if (!numbers) return numbers.error();
        columns.push_back(std::move(*numbers));
    }
    return columns;
}

struct ScatteredColumns {
    BandCount bands = BandCount::Three;
    std::vector<std::vector<double>> f, uRandom, uSystematic;
    std::vector<std::vector<bool>> out;  ///< by flags; one for all bands, or one each; or none

    [[nodiscard]] bool isOut(std::size_t band, std::size_t row) const {
        return !out.empty() && out[out.size() == 1 ? 0 : band][row];
    }
};

Result<ScatteredColumns> columnsOf(const Points& points) {
    ScatteredColumns all;
    all.bands = hasColumn(points, "f_r") ? BandCount::Three : BandCount::One;
    const auto take = [&](const std::string& name, auto& into) -> Result<void> {
        auto columns = bandColumns(points, name, all.bands);
        if (!columns) return columns.error();
        into = std::move(*columns);
        return {};
    };
    if (auto done = take("f", all.f); !done) return done.error();
    if (all.f.empty()) {
        return Error{ErrorKind::File, "csv: no columns of values, wanted f or f_r,f_g,f_b"};
    }
    if (auto done = take("u_random", all.uRandom); !done) return done.error();
    if (all.uRandom.empty()) {
        if (auto done = take("u", all.uRandom); !done) return done.error();
    } else if (auto done = take("u_systematic", all.uSystematic); !done) {
        return done.error();
    }
    std::vector<std::string> flags;
    for (const char* name : {"flags", "flags_r", "flags_g", "flags_b"}) {
        if (hasColumn(points, name)) flags.emplace_back(name);
    }
    const bool ofAll = flags.size() == 1 && flags.front() == "flags";
    const bool ofEach = flags.size() == 3 && flags.front() == "flags_r" && all.f.size() == 3;
    if (!flags.empty() && !ofAll && !ofEach) {
        std::string found;
        for (const std::string& name : flags) found += (found.empty() ? "" : ", ") + name;
        return Error{ErrorKind::File,
                     "csv: columns " + found +
                         "; wanted flags alone, or flags_r, flags_g, "
                         "flags_b beside f_r, f_g, f_b"};
    }
    for (const std::string& name : flags) {
        const auto masks = flagsOf(points, name);
        if (!masks) return masks.error();
        std::vector<bool>& out = all.out.emplace_back();
        for (const Flags one : *masks) out.push_back(isLost(one));
    }
    return all;
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

Result<BrdfData> fitDataOf(const Points& points, const DataOptions& options) {
    const Result<ScatteredColumns> columns = columnsOf(points);
    if (!columns) return columns.error();
    DataMaker maker(options);
    maker.data().bands = columns->bands;
    maker.data().uKnown = !columns->uRandom.empty();
    for (std::size_t i = 0; i < points.pairs.size(); ++i) {
        const LightView& pair = points.pairs[i];
        const bool below = !pair.in.aboveHorizon() || !pair.out.aboveHorizon();
        if (below) {
            maker.leaveOut();
            continue;
        }
        FitRow& row = maker.add(pair);
        for (std::size_t b = 0; b < columns->f.size(); ++b) {
            if (columns->isOut(b, i)) continue;
            row.f[b] = columns->f[b][i];
            if (!columns->uRandom.empty()) row.uRandom[b] = columns->uRandom[b][i];
            if (!columns->uSystematic.empty()) row.uSystematic[b] = columns->uSystematic[b][i];
        }
    }
    groupByIncidence(maker.data());
    return std::move(maker).finished();
}

}  // namespace gonio::proc
