#include "proc/plan/demands.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace gonio::proc {
namespace {

constexpr double kWithinReach = 1 - 1e-6;  // so that rounding does not put it out of reach

constexpr double kBin = 0.03;       // of the logarithm of a rate
constexpr double kDarkest = 1e-12;  // electrons per second

}  // namespace

Means Means::of(std::vector<ShotOption> options, int maxFrames) {
    Means means{.options = std::move(options), .maxFrames = maxFrames};
    for (const ShotOption& option : means.options)
        means.brightest = std::max(means.brightest, option.reach);
    return means;
}

double Means::mostInformation(double rate) const {
    double most = 0;
    for (const ShotOption& option : options)
        most = std::max(most, option.information(rate, maxFrames));
    return most * kWithinReach;
}

CellDemand demandOf(const PlanCell& cell,
                    const PlanGoal& goal,
                    double wanted,
                    const SystematicFloor& floor,
                    double brightest) {
    using Kind = CellDemand::Kind;
    if (cell.count <= 0) return {};
    if (cell.blinding()) return {.kind = Kind::Saturated};
    if (!cell.usable()) return {};
    if (cell.f < goal.fMin) return {.kind = Kind::BelowRange};
    if (cell.signal() <= 0) return {.kind = Kind::NoSignal};
    if (cell.rate > brightest) return {.kind = Kind::Saturated};
    const double worthwhile = goal.beyondFloor ? 0 : goal.floorShare * floor.at(cell.f) / cell.f;
    return {.kind = Kind::Planned,
            .relative = std::max(wanted, worthwhile),
            .heldAtTheFloor = worthwhile > wanted};
}

std::vector<CoverNeed> binnedNeeds(const std::vector<CoverNeed>& needs, const Means& means) {
    std::map<double, CoverNeed> bins;
    for (const CoverNeed& need : needs) {
        CoverNeed& bin = bins[std::floor(std::log(std::max(need.rate, kDarkest)) / kBin)];
        bin.rate = std::max(bin.rate, need.rate);
        bin.information = std::max(bin.information, need.information);
    }
    std::vector<CoverNeed> binned;
    for (const auto& [place, need] : bins) {
        binned.push_back(
            {.rate = need.rate,
             .information = std::min(need.information, means.mostInformation(need.rate))});
    }
    return binned;
}

StateDemands demandsOf(const StatePilot& state,
                       const std::function<CellDemand(const PlanCell&)>& demand,
                       const Means& means) {
    using Kind = CellDemand::Kind;
    StateDemands all;
    const auto missed = [&](std::size_t cell, Shortcoming why, std::size_t& counter) {
        all.unreached.push_back({.cell = cell, .why = why});
        counter += static_cast<std::size_t>(state.cells[cell].count);
    };
    for (std::size_t i = 0; i < state.cells.size(); ++i) {
        const PlanCell& cell = state.cells[i];
        const auto count = static_cast<std::size_t>(std::max(cell.count, 0));
        const CellDemand asked = demand(cell);
        switch (asked.kind) {
            case Kind::Ignored: all.counts.ignored += count; continue;
            case Kind::BelowRange: all.counts.belowRange += count; continue;
            case Kind::Saturated: missed(i, Shortcoming::Saturated, all.counts.saturated); continue;
            case Kind::NoSignal: missed(i, Shortcoming::NoSignal, all.counts.noSignal); continue;
            case Kind::Planned: break;
        }
        all.counts.planned += count;
        if (asked.heldAtTheFloor) all.counts.heldAtTheFloor += count;
        const double sigma = asked.relative * cell.signal();
        const double wanted = 1 / (cell.pixels * sigma * sigma);
        const double most = means.mostInformation(cell.rate);
        if (wanted > most) missed(i, Shortcoming::TooDim, all.counts.tooDim);
        all.needs.push_back({.rate = cell.rate, .information = std::min(wanted, most)});
    }
    return all;
}

CellCounts operator+(const CellCounts& a, const CellCounts& b) {
    return {.planned = a.planned + b.planned,
            .belowRange = a.belowRange + b.belowRange,
            .saturated = a.saturated + b.saturated,
            .tooDim = a.tooDim + b.tooDim,
            .noSignal = a.noSignal + b.noSignal,
            .ignored = a.ignored + b.ignored,
            .heldAtTheFloor = a.heldAtTheFloor + b.heldAtTheFloor};
}

}  // namespace gonio::proc
