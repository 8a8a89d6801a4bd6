#include "proc/fit/thinned_rows.h"

#include <algorithm>

namespace gonio::proc {

std::vector<std::uint32_t> thinnedRows(const BrdfData& data,
                                       const std::vector<bool>& groups,
                                       std::size_t count) {
    std::vector<std::vector<std::uint32_t>> byGroup(data.incidences.size());
    std::size_t total = 0;
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        const FitRow& row = data.rows[i];
        if (!groups[row.group]) continue;
        byGroup[row.group].push_back(static_cast<std::uint32_t>(i));
        ++total;
    }
    std::vector<std::uint32_t> kept;
    const auto fromMirror = [&](std::uint32_t i) {
        const Pair<double>& pair = data.nodes[data.rows[i].firstNode].pair;
        return squared(pair.out.x + pair.in.x) + squared(pair.out.y + pair.in.y) +
               squared(pair.out.z - pair.in.z);
    };
    for (std::vector<std::uint32_t>& rows : byGroup) {
        const std::size_t share =
            total <= count ? rows.size() : std::min(rows.size(), count * rows.size() / total + 1);
        const std::size_t near = total <= count ? 0 : share / 4;
        std::stable_sort(rows.begin(), rows.end(), [&](std::uint32_t a, std::uint32_t b) {
            return fromMirror(a) < fromMirror(b);
        });
        for (std::size_t i = 0; i < near; ++i) kept.push_back(rows[i]);
        const std::size_t left = rows.size() - near;
        const std::size_t even = share - near;
        std::sort(rows.begin() + static_cast<std::ptrdiff_t>(near), rows.end());
        for (std::size_t k = 0; k < even; ++k) kept.push_back(rows[near + k * left / even]);
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

BrdfData withRows(const BrdfData& data, const std::vector<std::uint32_t>& rows) {
    BrdfData only = data;
    only.rows.clear();
    only.nodes.clear();
    for (const std::uint32_t i : rows) {
        const auto nodes = data.nodesOf(data.rows[i]);
        only.rows.push_back(data.rows[i]);
        only.rows.back().firstNode = static_cast<std::uint32_t>(only.nodes.size());
        only.nodes.insert(only.nodes.end(), nodes.begin(), nodes.end());
    }
    return only;
}

}  // namespace gonio::proc
