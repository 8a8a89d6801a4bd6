#include "proc/quality/repeat.h"

#include <cmath>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr Radians kLobe = 10_deg, kFar = 30_deg;

struct Light {
    double signal = 0, variance = 0;
    void add(const CellSignal& from, std::size_t cell) {
        signal += from.signal[cell];
        variance += from.variance[cell];
    }
    [[nodiscard]] double relativeVariance() const { return variance / (signal * signal); }
};

struct Ratio {
    double value = 0, relativeVariance = 0;
};

template <class Wanted>
std::optional<Ratio> ratioOver(const CellSignal& first, const CellSignal& last, Wanted wanted) {
    Light before, after;
    for (std::size_t cell = 0; cell < first.size(); ++cell) {
        if (!first.present(cell) || !last.present(cell)) continue;
        if (!wanted(CellGrid::centre(cell))) continue;
        before.add(first, cell);
        after.add(last, cell);
    }
    if (!(before.signal > 0) || !(after.signal > 0)) return std::nullopt;
    return Ratio{.value = before.signal / after.signal,
                 .relativeVariance = before.relativeVariance() + after.relativeVariance()};
}

Change changeOf(const Ratio& ratio) {
    return {.size = ratio.value - 1, .u = ratio.value * std::sqrt(ratio.relativeVariance)};
}

bool sureAndLarge(const Change& change, double limit, const QualityLimits& limits) {
    const double size = std::abs(change.size);
    return size > limits.sure * change.u && size > limit;
}

Verdict unknown(const std::string& name, bool repeated) {
    return {.name = name,
            .figure = {},
            .evidence = repeated ? "its cells showed no light, or too much of it"
                                 : "the first bracket was not repeated as the last",
            .next = {}};
}

Figure figureOf(const Change& change, double limit) {
    return {.value = std::abs(change.size), .u = change.u, .unit = "1", .limit = limit};
}

}  // namespace

RepeatChange changeBetween(const CellSignal& first,
                           const CellSignal& last,
                           const Direction& mirror) {
    const auto away = [&](const Direction& wo) { return angleBetween({wo, mirror}); };
    const auto far = ratioOver(first, last, [&](const Direction& wo) { return away(wo) > kFar; });
    const auto lobe = ratioOver(first, last, [&](const Direction& wo) { return away(wo) < kLobe; });
    bool saturated = false;
    for (std::size_t cell = 0; cell < first.size(); ++cell) {
        const Flags flags = first.flags[cell] | last.flags[cell];
        saturated =
            saturated || (flags.has(Flag::Saturated) && away(CellGrid::centre(cell)) < kLobe);
    }
    RepeatChange change;
    if (far) change.drift = changeOf(*far);
    if (far && lobe && !saturated) {
        change.softness =
            changeOf({lobe->value / far->value, lobe->relativeVariance + far->relativeVariance});
    }
    return change;
}

Verdict softnessVerdict(const std::optional<RepeatChange>& change, const QualityLimits& limits) {
    if (!change || !change->softness) return unknown("softness", change.has_value());
    const Change& lobe = *change->softness;
    Verdict verdict{.name = "softness",
                    .grade = Grade::Ok,
                    .figure = figureOf(lobe, limits.softness),
                    .evidence = "from the first bracket to the last the lobe changed by " +
                                amount(-lobe.size, "1") + " against the rest",
                    .next = {}};
    if (!sureAndLarge(lobe, limits.softness, limits)) return verdict;
    verdict.grade = Grade::Refused;
    verdict.evidence = "the sample gives way under the rig: " + verdict.evidence;
    verdict.next =
        "let it lie under the rig until it rests and measure again; a sample that stays "
        "soft cannot be measured in contact";
    return verdict;
}

Verdict driftVerdict(const std::optional<RepeatChange>& change, const QualityLimits& limits) {
    if (!change || !change->drift) return unknown("drift", change.has_value());
    const Change& light = *change->drift;
    Verdict verdict{.name = "drift",
                    .grade = Grade::Ok,
                    .figure = figureOf(light, limits.drift),
                    .evidence = "from the first bracket to the last the light changed by " +
                                amount(-light.size, "1"),
                    .next = {}};
    if (!sureAndLarge(light, limits.drift, limits)) return verdict;
    verdict.grade = Grade::Warned;
    verdict.next = "let the LEDs warm up and measure again";
    return verdict;
}

}  // namespace gonio::proc
