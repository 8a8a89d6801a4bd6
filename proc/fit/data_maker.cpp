#include "proc/fit/data_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/median.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 3> kNoBand{kNan, kNan, kNan};

}  // namespace

FitRow& DataMaker::add(std::span<const WeightedNode> nodes, double cosThetaO) {
    FitRow row;
    row.firstNode = static_cast<std::uint32_t>(data_.nodes.size());
    row.nodeCount = static_cast<std::uint16_t>(nodes.size());
    row.cosThetaO = cosThetaO;
    row.f = row.uRandom = row.uSystematic = kNoBand;
    data_.nodes.insert(data_.nodes.end(), nodes.begin(), nodes.end());
    data_.rows.push_back(row);
    return data_.rows.back();
}

FitRow& DataMaker::add(const LightView& pair) {
    const WeightedNode node{pairOf<double>(pair), 1};
    return add(std::span(&node, 1), pair.out.z());
}

BrdfData DataMaker::finished() && {
    if (!data_.uKnown) assumeUncertainty();
    const double floor = options_.relativeFloor;
    for (FitRow& row : data_.rows) {
        for (std::size_t b = 0; b < 3; ++b) {
            if (floor > 0) row.uRandom[b] = std::hypot(row.uRandom[b], floor * row.f[b]);
            if (!std::isfinite(row.uSystematic[b])) row.uSystematic[b] = 0;
            const bool good =
                std::isfinite(row.f[b]) && std::isfinite(row.uRandom[b]) && row.uRandom[b] > 0;
            if (!good) row.f[b] = kNan;
        }
    }
    const std::size_t before = data_.rows.size();
    std::erase_if(data_.rows, [](const FitRow& row) {
        return std::none_of(row.f.begin(), row.f.end(), [](double f) { return std::isfinite(f); });
    });
    data_.leftOut += before - data_.rows.size();
    dropEmptyGroups();
    return std::move(data_);
}

void DataMaker::assumeUncertainty() {
    std::vector<std::vector<double>> sizes(data_.incidences.size());
    for (const FitRow& row : data_.rows) {
        for (const double f : row.f) {
            if (std::isfinite(f)) sizes[row.group].push_back(std::abs(f));
        }
    }
    std::vector<double> floor;
    floor.reserve(sizes.size());
    for (std::vector<double>& all : sizes) {
        floor.push_back(all.empty() ? 0 : 0.01 * median(std::move(all)));
    }
    for (FitRow& row : data_.rows) {
        for (std::size_t b = 0; b < 3; ++b) {
            const double size = std::abs(row.f[b]) + floor[row.group];
            row.uRandom[b] = options_.assumedRelative * size;
        }
    }
}

void DataMaker::dropEmptyGroups() {
    std::vector<bool> used(data_.incidences.size(), false);
    for (const FitRow& row : data_.rows) used[row.group] = true;
    std::vector<std::uint16_t> place(used.size());
    std::vector<Radians> incidences;
    BudgetShares shared;
    for (std::size_t g = 0; g < used.size(); ++g) {
        place[g] = static_cast<std::uint16_t>(incidences.size());
        if (!used[g]) continue;
        incidences.push_back(data_.incidences[g]);
        if (!data_.shared.empty()) shared.push_back(data_.shared[g]);
    }
    for (FitRow& row : data_.rows) row.group = place[row.group];
    data_.incidences = std::move(incidences);
    data_.shared = std::move(shared);
}

}  // namespace gonio::proc
