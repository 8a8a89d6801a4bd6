#include "proc/table/budget_shares.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

using Json = nlohmann::json;

/// A number at `key`, 0 where there is none.
double numberAt(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return 0;
    const auto value = found->get<double>();
    return std::isfinite(value) ? value : 0;
}

std::string textAt(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

BudgetShare shareOf(const Json& components) {
    BudgetShare share;
    for (const Json& one : components) {
        if (!one.is_object()) continue;
        const double relative = numberAt(one, "median_relative");
        const std::string correlation = textAt(one, "correlation");
        if (correlation == "per cell" && textAt(one, "type") == "B") {
            share.patch = share.cell = std::hypot(share.patch, std::sqrt(0.5) * relative);
        }
        if (correlation == "per state") share.state = std::hypot(share.state, relative);
        const bool tilt = textAt(one, "name") == "tilt of the sample";
        if (correlation == "common" && !tilt) share.common = std::hypot(share.common, relative);
    }
    return share;
}

}  // namespace

BudgetShares budgetShares(const SampleSet& set) {
    BudgetShares shares(set.leds.size());
    const Json budget = Json::parse(set.info.budgetJson, nullptr, false);
    if (!budget.is_array()) return shares;
    for (const Json& state : budget) {
        if (!state.is_object()) continue;
        const double led = numberAt(state, "led");
        const std::string band = textAt(state, "band");
        const auto components = state.find("components");
        if (!(led >= 0 && led < static_cast<double>(shares.size()))) continue;
        if (components == state.end() || !components->is_array()) continue;
        for (const Band b : kBands) {
            if (letter(b) != band) continue;
            shares[static_cast<std::size_t>(led)][index(b)] = shareOf(*components);
        }
    }
    return shares;
}

std::size_t patchOf(std::size_t cell) {
    const CellPlace place = CellGrid::place(cell);
    const int ring = place.row / kPatchDegrees;
    const int middle = ring * kPatchDegrees + kPatchDegrees / 2;
    const int patches = CellGrid::sectors(middle) / kPatchDegrees;
    const int within = place.sector * patches / CellGrid::sectors(place.row);
    constexpr std::size_t kMostInRing = 360 / kPatchDegrees;
    return static_cast<std::size_t>(ring) * kMostInRing + static_cast<std::size_t>(within);
}

}  // namespace gonio::proc
