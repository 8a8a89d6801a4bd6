#include "proc/table/spherical_lookup.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTurn = 360;
/// As proc/table/axis.h: within this of a pole a direction is the pole, in degrees.
constexpr double kSame = 1e-9;

bool ascends(const std::vector<double>& axis) {
    return !axis.empty() && std::isfinite(axis.front()) && std::isfinite(axis.back()) &&
           std::adjacent_find(axis.begin(), axis.end(), std::greater_equal<>()) == axis.end();
}

/// What is wrong with a block; empty when it can be looked up.
std::string complaint(const SphericalTable& table, const SphericalBlock& block) {
    if (block.channel >= table.channels.size()) {
        return "channel " + std::to_string(block.channel + 1) + ", the table has " +
               std::to_string(table.channels.size());
    }
    if (!ascends(block.azimuthDeg) || !ascends(block.thetaDeg)) return "axes do not ascend";
    const std::size_t wanted = block.azimuthDeg.size() * block.thetaDeg.size();
    if (block.f.size() != wanted) {
        return std::to_string(block.f.size()) + " values, its axes want " + std::to_string(wanted);
    }
    return "";
}

/// On an axis that covers half a circle, at `at` or `at` plus a turn; the axis does not wrap.
std::optional<AxisPlace> placeOnArc(const std::vector<double>& axis, double at) {
    at -= kTurn * std::floor((at - axis.front()) / kTurn);
    if (axis.front() + kTurn - at <= kSame) return AxisPlace{};
    return placeOn(axis, at);
}

/// Of even cells: what lies in the outer half of the first or the last cell is taken as its centre.
double heldInCells(const SphericalTable& table, const std::vector<double>& axis, double at) {
    if (!table.cellCentred) return at;
    constexpr double kRounding = 1e-9;
    const double cell = axis.size() > 1 ? axis[1] - axis[0] : 2 * std::min(axis[0], 180 - axis[0]);
    const double half = cell / 2 + kRounding;
    if (at < axis.front() && at >= axis.front() - half) return axis.front();
    if (at > axis.back() && at <= axis.back() + half) return axis.back();
    return at;
}

std::optional<AxisPlace> placeAzimuth(const SphericalTable& table,
                                      const SphericalBlock& block,
                                      double azimuth) {
    if (!table.planeSymmetrical) return placeOnCircle(block.azimuthDeg, azimuth);
    if (table.cellCentred) {
        const double away = std::abs(std::remainder(azimuth - table.mirrorAzimuthDeg, 360.0));
        const double folded = table.mirrorAzimuthDeg - away;
        return placeOn(block.azimuthDeg, heldInCells(table, block.azimuthDeg, folded));
    }
    if (const auto here = placeOnArc(block.azimuthDeg, azimuth)) return here;
    return placeOnArc(block.azimuthDeg, 2 * table.mirrorAzimuthDeg - azimuth);
}

/// Of the cells about the normal; NaN where there is no data.
double ringMean(const SphericalBlock& block, std::size_t theta) {
    double mean = 0;
    double count = 0;
    for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
        const double f = block.f[block.index(a, theta)];
        if (!std::isnan(f)) mean += (f - mean) / ++count;
    }
    return count > 0 ? mean : kNan;
}

/// (1 - t) low + t high; what has no weight is not asked, so that its NaN cannot answer.
template <class Value, class At>
Value between(const AxisPlace& place, const At& at) {
    Value value = at(place.low);
    if (place.atNode()) return value;
    value.f = (1 - place.t) * value.f + place.t * at(place.high).f;
    value.node = false;
    return value;
}

}  // namespace

Result<SphericalLookup> SphericalLookup::over(SphericalTable table, BandChannels channels) {
    if (table.blocks.empty()) return Error{ErrorKind::File, "look-up: table has no blocks"};
    std::map<std::array<double, 4>, std::size_t> seen;
    for (std::size_t i = 0; i < table.blocks.size(); ++i) {
        const SphericalBlock& block = table.blocks[i];
        std::string wrong = complaint(table, block);
        const std::array<double, 4> id{static_cast<double>(block.channel),
                                       block.transmission ? 1.0 : 0.0,
                                       block.lightAzimuthDeg,
                                       block.incidenceDeg};
        const auto [first, fresh] = seen.emplace(id, i);
        if (wrong.empty() && !fresh) {
            wrong = "same light and channel as block " + std::to_string(first->second + 1);
        }
        if (!wrong.empty()) {
            return Error{ErrorKind::File, "look-up: block " + std::to_string(i + 1) + ": " + wrong};
        }
    }
    for (const ChannelBlend& blend : channels.bands) {
        if (std::max(blend.low, blend.high) >= table.channels.size()) {
            return Error{ErrorKind::File, "look-up: a band asks for a channel that is not there"};
        }
    }
    return SphericalLookup(std::move(table), channels);
}

SphericalLookup::SphericalLookup(SphericalTable table, BandChannels channels)
    : table_(std::move(table)), channels_(channels), isotropic_(table_.isotropic()) {
    arrange();
}

void SphericalLookup::arrange() {
    std::vector<std::size_t> order(table_.blocks.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const SphericalBlock& x = table_.blocks[a];
        const SphericalBlock& y = table_.blocks[b];
        return std::pair(x.lightAzimuthDeg, x.incidenceDeg) <
               std::pair(y.lightAzimuthDeg, y.incidenceDeg);
    });
    sides_.resize(2 * table_.channels.size());
    for (const std::size_t i : order) {
        const SphericalBlock& block = table_.blocks[i];
        Side& side = sides_[2 * block.channel + (block.transmission ? 1 : 0)];
        if (side.fans.empty() || side.lightAzimuthDeg.back() != block.lightAzimuthDeg) {
            side.lightAzimuthDeg.push_back(block.lightAzimuthDeg);
            side.fans.emplace_back();
        }
        side.fans.back().incidenceDeg.push_back(block.incidenceDeg);
        side.fans.back().block.push_back(i);
    }
}

SphericalLookup::Place SphericalLookup::placeOf(const LightView& pair) const {
    const double light = pair.in.phi().degrees();
    const double theta = pair.out.theta().degrees();
    return {.lightAzimuth = light,
            .incidence = pair.in.theta().degrees(),
            .azimuth = pair.out.phi().degrees() - light - 180 + table_.mirrorAzimuthDeg,
            .theta = theta,
            .pole = theta <= kSame || theta >= 180 - kSame};
}

SphericalLookup::Value SphericalLookup::inSide(const Side& side, const Place& place) const {
    if (side.fans.empty()) return {kNan, false};
    const auto light =
        isotropic_ ? AxisPlace{} : placeOnCircle(side.lightAzimuthDeg, place.lightAzimuth);
    if (!light) return {kNan, false};
    return between<Value>(*light, [&](std::size_t i) { return inFan(side.fans[i], place); });
}

SphericalLookup::Value SphericalLookup::inFan(const Fan& fan, const Place& place) const {
    const auto incidence =
        placeOn(fan.incidenceDeg, heldInCells(table_, fan.incidenceDeg, place.incidence));
    if (!incidence) return {kNan, false};
    return between<Value>(
        *incidence, [&](std::size_t i) { return inBlock(table_.blocks[fan.block[i]], place); });
}

SphericalLookup::Value SphericalLookup::inBlock(const SphericalBlock& block,
                                                const Place& place) const {
    const auto theta = placeOn(block.thetaDeg, heldInCells(table_, block.thetaDeg, place.theta));
    if (!theta) return {kNan, false};
    if (place.pole && table_.cellCentred) return {ringMean(block, theta->low), false};
    if (place.pole) {
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            const double f = block.f[block.index(a, theta->low)];
            if (!std::isnan(f)) return {f, true};
        }
        return {kNan, true};
    }
    const auto azimuth = block.isRound() ? AxisPlace{} : placeAzimuth(table_, block, place.azimuth);
    if (!azimuth) return {kNan, false};
    return between<Value>(*azimuth, [&](std::size_t a) {
        return between<Value>(*theta, [&](std::size_t t) {
            return Value{block.f[block.index(a, t)], true};
        });
    });
}

Answer SphericalLookup::answer(const LightView& pair) const {
    const bool below = pair.out.z() < 0;
    const auto sideOf = [&](std::size_t channel) -> const Side& { return side(channel, below); };
    if (!pair.in.aboveHorizon() || pair.out.z() == 0 ||
        sideOf(channels_.bands[0].low).fans.empty()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const Place place = placeOf(pair);
    const std::size_t asked = channels_.count == BandCount::One ? 1 : 3;
    LedBands f;
    bool node = true;
    for (std::size_t i = 0; i < asked; ++i) {
        const ChannelBlend& blend = channels_.bands[i];
        f.value[i] = blend.of([&](std::size_t channel) {
            const Value value = inSide(sideOf(channel), place);
            node = node && value.node;
            return value.f;
        });
        node = node && blend.t == 0;
    }
    const Source source = node ? Source::Measured : Source::Interpolated;
    Answer answer = Answer::none({}, source);
    answer.f = asked == 1 ? LedBands::all(f.value[0]) : f;
    const auto missing = [](double value) { return std::isnan(value); };
    if (!std::all_of(answer.f.value.begin(), answer.f.value.end(), missing)) {
        answer.flags.set(node ? Flag::Measured : Flag::Interpolated);
    }
    return answer;
}

}  // namespace gonio::proc
