#include "proc/estimate/seed004.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "proc/estimate/band_wise.h"
#include "proc/estimate/clamp_extrapolator.h"
#include "proc/estimate/linear_extrapolator.h"
#include "proc/estimate/no_extrapolation.h"
#include "proc/table/scattered_of.h"

namespace gonio::proc {
namespace {

using Made = Result<std::unique_ptr<Scatterer>>;
constexpr std::size_t kMostPlanes = 256;
constexpr double kSameIncidence = 1e-6;  ///< radians

constexpr std::array<std::pair<SeedInterpolator, std::string_view>, 3> kInterpolators{{
    {SeedInterpolator::Shepard, "shepard"},
    {SeedInterpolator::AxisLinear, "axis-linear"},
    {SeedInterpolator::GridLinear, "grid-linear"},
}};
constexpr std::array<std::pair<SeedExtrapolator, std::string_view>, 5> kExtrapolators{{
    {SeedExtrapolator::None, "none"},
    {SeedExtrapolator::Linear, "linear"},
    {SeedExtrapolator::Constant, "constant"},
    {SeedExtrapolator::Bezier, "bezier"},
    {SeedExtrapolator::Gradient, "gradient"},
}};

template <class Named>
auto valueIn(const Named& all, std::string_view name)
    -> std::optional<typename Named::value_type::first_type> {
    for (const auto& [value, own] : all) {
        if (own == name) return value;
    }
    return std::nullopt;
}

/// The different angles of incidence, ascending.
std::vector<Radians> incidencesOf(const ScatteredSet& data) {
    std::vector<Radians> all;
    for (const SampleId id : data.ids()) all.push_back(data.find(id)->pair.in.theta());
    std::sort(all.begin(), all.end());
    const auto same = [](Radians a, Radians b) { return (b - a).value() < kSameIncidence; };
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    return all;
}

/// Of one side's directions; below 90 degrees, where an edge must be.
Radians largestTheta(const ScatteredSet& data, Direction LightView::*side) {
    Radians largest(0);
    for (const SampleId id : data.ids()) {
        largest = std::max(largest, (data.find(id)->pair.*side).theta());
    }
    return std::min(largest, Radians(std::nextafter((90_deg).value(), 0.0)));
}

Made interpolator(const ScatteredSet& data, const Seed004Options& options, SeedInterpolator which) {
    if (which == SeedInterpolator::Shepard) return makeShepard(data, options.shepard);
    if (which == SeedInterpolator::AxisLinear) return makeAxisLinear(data, options.axisLinear);
    if (options.gridFilledBy == SeedInterpolator::GridLinear) {
        return Error{ErrorKind::Usage, "grid-linear: a grid cannot be filled by a grid"};
    }
    GridLinearOptions grid = options.gridLinear;
    if (grid.incidences.empty()) grid.incidences = incidencesOf(data);
    if (grid.incidences.size() > kMostPlanes) {
        return Error{ErrorKind::Usage,
                     "grid-linear: data of " + std::to_string(grid.incidences.size()) +
                         " angles of incidence; say at which the planes shall stand"};
    }
    const Made inner = interpolator(data, options, options.gridFilledBy);
    if (!inner) return inner.error();
    return makeGridLinear(**inner, grid);
}

Made beyond(Made inner, const Seed004Options& options, const Beyond& edge) {
    if (!inner) return inner;
    const auto method =
        edge.side == Side::Outgoing ? options.beyondOutgoing : options.beyondIncoming;
    switch (method) {
        case SeedExtrapolator::None: return makeNoExtrapolation(std::move(*inner), edge);
        case SeedExtrapolator::Linear: return makeLinearExtrapolator(std::move(*inner), edge);
        case SeedExtrapolator::Constant: return makeClampExtrapolator(std::move(*inner), edge);
        case SeedExtrapolator::Bezier:
            return makeBezierExtrapolator(std::move(*inner), edge, options.bezier);
        case SeedExtrapolator::Gradient:
            return makeGradientExtrapolator(std::move(*inner), edge, options.gradient);
    }
    return inner;
}

/// Whether a cell that is usable in one band is so in all.
bool sameCells(const SampleSet& sample) {
    for (const LedTable& led : sample.leds) {
        const std::size_t cells = std::max(
            {led.bands[0].flags.size(), led.bands[1].flags.size(), led.bands[2].flags.size()});
        for (std::size_t cell = 0; cell < cells; ++cell) {
            const bool first = led.bands[0].usable(cell);
            if (led.bands[1].usable(cell) != first || led.bands[2].usable(cell) != first) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

std::optional<Seed004Options> seed004Named(std::string_view name) {
    const std::size_t colon = name.find(':');
    const auto interpolator = valueIn(kInterpolators, name.substr(0, colon));
    if (!interpolator) return std::nullopt;
    Seed004Options options{.interpolator = *interpolator};
    if (colon == std::string_view::npos) return options;
    const auto beyond = valueIn(kExtrapolators, name.substr(colon + 1));
    if (!beyond) return std::nullopt;
    options.beyondOutgoing = options.beyondIncoming = *beyond;
    return options;
}

std::string seed004Names() {
    std::string all;
    for (const auto& [value, name] : kInterpolators) all += std::string(name) + ", ";
    all += "each alone or with";
    for (const auto& [value, name] : kExtrapolators) {
        all += (value == SeedExtrapolator::None ? " :" : ", :") + std::string(name);
    }
    return all;
}

Result<std::unique_ptr<Scatterer>> makeSeed004(const ScatteredSet& data,
                                               const Seed004Options& options) {
    if (data.empty()) {
        return Error{ErrorKind::Quality,
                     "estimate: no value can be used: all are missing, saturated or blocked"};
    }
    const Beyond outgoing{Side::Outgoing,
                          options.outgoingEdge.value_or(largestTheta(data, &LightView::out))};
    const Beyond incoming{Side::Incoming,
                          options.incomingEdge.value_or(largestTheta(data, &LightView::in))};
    return beyond(beyond(interpolator(data, options, options.interpolator), options, outgoing),
                  options,
                  incoming);
}

Result<std::unique_ptr<Scatterer>> makeSeed004(const SampleSet& sample,
                                               const Seed004Options& options) {
    if (sameCells(sample)) {
        const Result<Scattered> all = scatteredOf(sample);
        return all ? makeSeed004(all->set, options) : all.error();
    }
    std::array<std::unique_ptr<const Scatterer>, 3> bands;
    for (const Band band : kBands) {
        const Result<Scattered> own = scatteredOf(sample, band);
        if (!own) return own.error();
        if (own->set.empty()) continue;
        Made made = makeSeed004(own->set, options);
        if (!made) return made.error();
        bands[index(band)] = std::move(*made);
    }
    return std::unique_ptr<Scatterer>(std::make_unique<BandWise>(std::move(bands)));
}

Result<std::unique_ptr<Scatterer>> makeSeed004(const SpecularTable& table,
                                               const Seed004Options& options) {
    const Result<Scattered> nodes = scatteredOf(table);
    return nodes ? makeSeed004(nodes->set, options) : nodes.error();
}

}  // namespace gonio::proc
