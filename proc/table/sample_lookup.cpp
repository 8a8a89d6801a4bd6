#include "proc/table/sample_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/coordinates.h"
#include "proc/optics/cell_blend.h"
#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

constexpr double kAtLedDeg = 0.5;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Share {
    std::size_t led = 0;
    std::size_t cell = 0;
    double weight = 0;
};

/// The cells that an answer is made of; weights above 0, their sum 1.
class Blend {
public:
    void add(Share share) {
        if (share.weight > 0) shares_[count_++] = share;
    }
    [[nodiscard]] std::span<const Share> shares() const { return {shares_.data(), count_}; }
    [[nodiscard]] bool oneCell() const { return count_ == 1; }

private:
    std::array<Share, 8> shares_{};  // two LEDs x two rows x two sectors
    std::size_t count_ = 0;
};

/// One LED and what it weighs in the answer.
struct LedShare {
    std::size_t led = 0;
    double weight = 1;
};

/// wo is above the horizon.
void addCells(Blend& blend, LedShare share, const Direction& wo) {
    const CellBlend around(wo);
    for (const CellWeight& one : around.cells()) {
        blend.add({share.led, one.cell, share.weight * one.weight});
    }
}

/// Adds one cell's part to the answer's band. u_random is summed in squares.
void accumulate(Answer& answer, Band band, const CellSamples& cells, const Share& share) {
    if (cells.size() <= share.cell) {
        answer.f[band] = kNan;
        return;
    }
    const double w = share.weight;
    const double random = w * cells.uRandom[share.cell];
    answer.f[band] += w * cells.f[share.cell];
    (*answer.uRandom)[band] += random * random;
    (*answer.uSystematic)[band] += w * cells.uSystematic[share.cell];
    answer.flags = answer.flags | cells.flags[share.cell];
}

Answer blended(const SampleSet& set, const Blend& blend) {
    Answer answer;
    answer.uRandom = LedBands{};
    answer.uSystematic = LedBands{};
    answer.source = blend.oneCell() ? Source::Measured : Source::Interpolated;
    bool any = false;
    for (Band band : kBands) {
        for (const Share& share : blend.shares()) {
            accumulate(answer, band, set.leds[share.led].bands[index(band)], share);
        }
        (*answer.uRandom)[band] = std::sqrt((*answer.uRandom)[band]);
        const bool missing = std::isnan(answer.f[band]);
        if (missing) (*answer.uRandom)[band] = (*answer.uSystematic)[band] = kNan;
        any = any || !missing;
    }
    if (!blend.oneCell() || !any) answer.flags.clear(Flag::Measured);
    if (!blend.oneCell() && any) answer.flags.set(Flag::Interpolated);
    return any ? answer : Answer::none(answer.flags, answer.source);
}

/// The LED whose own incidence this is.
std::optional<std::size_t> ledAt(std::span<const double> incidenceDeg, double atDeg) {
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < incidenceDeg.size(); ++i) {
        const double away = std::abs(incidenceDeg[i] - atDeg);
        if (away > kAtLedDeg) continue;
        if (!nearest || away < std::abs(incidenceDeg[*nearest] - atDeg)) nearest = i;
    }
    return nearest;
}

}  // namespace

SampleLookup::SampleLookup(SampleSet set) : set_(std::move(set)) {
    std::sort(set_.leds.begin(), set_.leds.end(), [](const LedTable& a, const LedTable& b) {
        return a.incidence < b.incidence;
    });
    for (const LedTable& led : set_.leds) incidenceDeg_.push_back(led.incidence.degrees());
}

Answer SampleLookup::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const double atDeg = pair.in.theta().degrees();
    Blend blend;
    if (const auto led = ledAt(incidenceDeg_, atDeg)) {
        addCells(blend, {*led, 1}, pair.out.turned(-pair.in.phi()));
        return blended(set_, blend);
    }
    const auto place = placeOn(incidenceDeg_, atDeg);
    if (!place) return Answer::none({}, Source::Interpolated);
    const SpecularRelative at = toSpecularRelative(pair);
    for (const LedShare share :
         {LedShare{place->low, 1 - place->t}, LedShare{place->high, place->t}}) {
        const Direction wi = Direction::fromSpherical(set_.leds[share.led].incidence, Radians(0));
        const Direction wo = fromSpecularRelative(wi, at);
        if (!wo.aboveHorizon()) return Answer::none({}, Source::Interpolated);
        addCells(blend, share, wo);
    }
    return blended(set_, blend);
}

}  // namespace gonio::proc
