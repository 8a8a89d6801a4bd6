#include "proc/table/sample_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "proc/core/coordinates.h"
#include "proc/optics/cell_blend.h"
#include "proc/table/axis.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr double kAtLedDeg = 0.5;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Share {
    std::size_t led = 0;
    std::size_t cell = 0;
    double weight = 0;
};

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

/// The cells that an answer is made of; weights above 0, their sum 1.
class SampleLookup::Blend {
public:
    void add(Share share) {
        if (share.weight > 0) shares_[count_++] = share;
    }
    /// What an LED sees around wo, which is above the horizon.
    void addCells(std::size_t led, const Direction& wo, double weight) {
        const CellBlend around(wo);
        for (const CellWeight& one : around.cells()) add({led, one.cell, weight * one.weight});
    }
    [[nodiscard]] std::span<const Share> shares() const { return {shares_.data(), count_}; }
    [[nodiscard]] bool oneCell() const { return count_ == 1; }

private:
    std::array<Share, 16> shares_{};  // two rotations x two LEDs x two rows x two sectors
    std::size_t count_ = 0;
};

SampleLookup::SampleLookup(SampleSet set) : set_(std::move(set)) {
    sortTables(set_);
    for (std::size_t i = 0; i < set_.leds.size(); ++i) {
        const LedTable& led = set_.leds[i];
        if (turns_.empty() || !sameRotation(turns_.back().rotation, led.rotation)) {
            turns_.push_back({.rotation = led.rotation, .first = i, .incidenceDeg = {}});
            rotationDeg_.push_back(led.rotation.degrees());
        }
        turns_.back().incidenceDeg.push_back(led.incidence.degrees());
    }
}

Answer SampleLookup::blended(const Blend& blend) const {
    Answer answer;
    answer.uRandom = LedBands{};
    answer.uSystematic = LedBands{};
    answer.source = blend.oneCell() ? Source::Measured : Source::Interpolated;
    bool any = false;
    for (Band band : kBands) {
        for (const Share& share : blend.shares()) {
            accumulate(answer, band, set_.leds[share.led].bands[index(band)], share);
        }
        (*answer.uRandom)[band] = std::sqrt((*answer.uRandom)[band]);
        const bool missing = std::isnan(answer.f[band]);
        if (missing) (*answer.uRandom)[band] = (*answer.uSystematic)[band] = kNan;
        any = any || !missing;
    }
    if (!blend.oneCell() || !any) answer.flags.clear(Flag::Measured);
    if (!blend.oneCell() && any) answer.flags.set(Flag::Interpolated);
    const auto unknown = [](double u) { return std::isnan(u); };
    for (auto* u : {&answer.uRandom, &answer.uSystematic}) {
        if (std::all_of((*u)->value.begin(), (*u)->value.end(), unknown)) u->reset();
    }
    return any ? answer : Answer::none(answer.flags, answer.source);
}

/// False: what this rotation measured does not tell.
bool SampleLookup::addTurn(Blend& blend,
                           const Turn& turn,
                           const LightView& pair,
                           double weight) const {
    const double atDeg = pair.in.theta().degrees();
    if (const auto led = ledAt(turn.incidenceDeg, atDeg)) {
        // Under an LED at the normal the view alone says how the sample lay.
        const bool normal = turns_.size() > 1 && turn.incidenceDeg[*led] < kAtLedDeg;
        const Radians turned = normal ? turn.rotation : -pair.in.phi();
        blend.addCells(turn.first + *led, pair.out.turned(turned), weight);
        return true;
    }
    const auto place = placeOn(turn.incidenceDeg, atDeg);
    if (!place) return false;
    const SpecularRelative at = toSpecularRelative(pair);
    for (const auto& [led, share] :
         {std::pair{place->low, 1 - place->t}, std::pair{place->high, place->t}}) {
        const std::size_t table = turn.first + led;
        const Direction wi = Direction::fromSpherical(set_.leds[table].incidence, Radians(0));
        const Direction wo = fromSpecularRelative(wi, at);
        if (!wo.aboveHorizon()) return false;
        blend.addCells(table, wo, weight * share);
    }
    return true;
}

Answer SampleLookup::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    if (turns_.empty()) return Answer::none({}, Source::Interpolated);
    const bool normal = pair.in.theta() < 1e-6_deg;
    const auto place = turns_.size() == 1 || normal
                           ? AxisPlace{}
                           : placeOnCircle(rotationDeg_, -pair.in.phi().degrees());
    if (!place) return Answer::none({}, Source::Interpolated);
    Blend blend;
    const bool told = addTurn(blend, turns_[place->low], pair, 1 - place->t) &&
                      (place->atNode() || addTurn(blend, turns_[place->high], pair, place->t));
    return told ? blended(blend) : Answer::none({}, Source::Interpolated);
}

}  // namespace gonio::proc
