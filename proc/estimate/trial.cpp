#include "proc/estimate/trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/parallel.h"
#include "proc/estimate/reciprocal_method.h"
#include "proc/fit/thinned_rows.h"

namespace gonio::proc {
namespace {

Radians fromMirror(const BrdfData& data, const FitRow& row) {
    const LightView pair = viewOf(data.nodesOf(row).front().pair);
    return angleBetween({.in = mirrorOf(pair.in), .out = pair.out});
}

/// Mean over the row's nodes.
struct RowAnswer {
    LedBands f;
    std::array<Reach, 3> reach;  ///< by band
};

RowAnswer rowAnswer(const IncidenceMethod& method,
                    const Coverage& coverage,
                    std::span<const WeightedNode> nodes) {
    RowAnswer mean;
    for (const WeightedNode& node : nodes) {
        const ReciprocalAnswer one = reciprocalAnswer(method, coverage, viewOf(node.pair));
        mean.f = mean.f + one.value.f * node.weight;
        for (std::size_t b = 0; b < 3; ++b) {
            const Reach& reach = one.ways[b].reach;
            mean.reach[b].between += node.weight * reach.between;
            mean.reach[b].steps += node.weight * reach.steps;
            mean.reach[b].beyondIncidence =
                mean.reach[b].beyondIncidence + reach.beyondIncidence * node.weight;
        }
    }
    return mean;
}

ProbeError errorOf(const BrdfData& data,
                   const FitRow& row,
                   std::size_t band,
                   double answer,
                   const ErrorScale& scale) {
    ProbeError error;
    error.off = answer - row.f[band];
    error.u = data.uKnown ? data.uOf(row, band) : 0;
    error.toAnswer = scale.of(answer, band);
    error.dark = scale.isDark(answer, band);
    error.toBoth = std::hypot(
        std::hypot(error.toAnswer, scale.of(row.f[band], band)) / std::sqrt(2.0), error.u);
    return error;
}

BrdfData upTo(const BrdfData& data, double leastCosine) {
    std::vector<std::uint32_t> rows;
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        if (data.rows[i].cosThetaO >= leastCosine) rows.push_back(static_cast<std::uint32_t>(i));
    }
    return withRows(data, rows);
}

std::vector<bool> allBut(std::size_t groups, std::optional<std::size_t> without) {
    std::vector<bool> seen(groups, true);
    if (without) seen[*without] = false;
    return seen;
}

}  // namespace

Trial::Trial(const BrdfData& data, std::optional<BrdfData> inner, std::vector<bool> groups)
    : data_(&data),
      inner_(std::move(inner)),
      groups_(std::move(groups)),
      coverage_(seen(), groups_) {}

Trial Trial::withoutIncidence(const BrdfData& data,
                              std::size_t group,
                              const TrialOptions& options) {
    Trial trial(data, std::nullopt, allBut(data.incidences.size(), group));
    trial.without_ = group;
    trial.addProbes(group, std::numeric_limits<double>::infinity(), options);
    return trial;
}

std::optional<Trial> Trial::withoutEdge(const BrdfData& data, const TrialOptions& options) {
    constexpr double kLeftOutDeg = 15;
    constexpr double kLeastLeftDeg = 20;
    double least = 1;
    for (const FitRow& row : data.rows) least = std::min(least, row.cosThetaO);
    const double edgeDeg = std::acos(least) * 180 / kPi - kLeftOutDeg;
    if (edgeDeg < kLeastLeftDeg) return std::nullopt;
    const double cosine = cos(Radians::fromDegrees(edgeDeg));
    const std::size_t groups = data.incidences.size();
    Trial trial(data, upTo(data, cosine), allBut(groups, std::nullopt));
    for (std::size_t g = 0; g < groups; ++g) trial.addProbes(g, cosine, options);
    return trial;
}

void Trial::addProbes(std::size_t group, double mostCosine, const TrialOptions& options) {
    std::vector<std::uint32_t> rows;
    for (std::size_t i = 0; i < data_->rows.size(); ++i) {
        const FitRow& row = data_->rows[i];
        if (row.group == group && row.cosThetaO < mostCosine) {
            rows.push_back(static_cast<std::uint32_t>(i));
        }
    }
    std::vector<std::pair<double, std::uint32_t>> others;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (k % options.stride == 0) {
            probes_.push_back({rows[k], true});
        } else {
            others.emplace_back(fromMirror(*data_, data_->rows[rows[k]]).value(), rows[k]);
        }
    }
    std::sort(others.begin(), others.end());
    const std::size_t near = std::min(options.lobeRows, others.size());
    for (std::size_t k = 0; k < near; ++k) probes_.push_back({others[k].second, false});
}

std::vector<ProbeError> Trial::errorsOf(const IncidenceMethod& method,
                                        const ErrorScale& scale) const {
    std::vector<RowAnswer> answers(probes_.size());
    parallelFor(probes_.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            answers[i] = rowAnswer(method, coverage_, data_->nodesOf(data_->rows[probes_[i].row]));
        }
    });
    std::vector<std::array<double, 3>> peaks(data_->incidences.size(), {0, 0, 0});
    for (const Probe& probe : probes_) {
        const FitRow& row = data_->rows[probe.row];
        for (std::size_t b = 0; b < 3; ++b) {
            if (row.f[b] > peaks[row.group][b]) peaks[row.group][b] = row.f[b];
        }
    }
    std::vector<ProbeError> errors;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        const FitRow& row = data_->rows[probes_[i].row];
        const Radians away = fromMirror(*data_, row);
        for (std::size_t b = 0; b < data_->bandsUsed(); ++b) {
            if (std::isnan(row.f[b]) || !coverage_.has(b)) continue;
            ProbeError error = errorOf(*data_, row, b, answers[i].f.value[b], scale);
            error.reach = answers[i].reach[b];
            error.fromMirror = away;
            error.even = probes_[i].even;
            error.lobe = row.f[b] > 0.1 * peaks[row.group][b];
            errors.push_back(error);
        }
    }
    return errors;
}

}  // namespace gonio::proc
