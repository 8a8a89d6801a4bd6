#include "proc/calibrate/budget_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace gonio::proc {
namespace {

using Json = nlohmann::json;

constexpr double kMostLeds = 1000;  // beyond any rig's

std::optional<double> numberAt(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return std::nullopt;
    const auto value = found->get<double>();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string textAt(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

Correlation correlationOf(const std::string& text) {
    for (const Correlation one : {Correlation::PerCell, Correlation::PerState}) {
        if (text == name(one)) return one;
    }
    return Correlation::Common;
}

BudgetComponent componentOf(const Json& json) {
    BudgetComponent component{
        .name = textAt(json, "name"),
        .type = textAt(json, "type") == "A" ? 'A' : 'B',
        .correlation = correlationOf(textAt(json, "correlation")),
        .medianRelative = numberAt(json, "median_relative").value_or(std::nan("")),
        .size = numberAt(json, "size").value_or(0)};
    if (const std::string unit = textAt(json, "unit"); !unit.empty()) component.unit = unit;
    component.freedom = numberAt(json, "freedom");
    return component;
}

std::optional<StateBudget> stateOf(const Json& json) {
    if (!json.is_object()) return std::nullopt;
    const auto led = numberAt(json, "led");
    const std::string band = textAt(json, "band");
    const auto known = std::find_if(
        kBands.begin(), kBands.end(), [&](const Band one) { return letter(one) == band; });
    if (!led || *led < 0 || *led >= kMostLeds || known == kBands.end()) return std::nullopt;
    StateBudget state{.led = static_cast<std::size_t>(*led), .band = *known, .components = {}};
    const double cells = numberAt(json, "monte_carlo_cells").value_or(0);
    if (cells > 0 && cells < 1e9) state.monteCarloCells = static_cast<std::size_t>(cells);
    const auto components = json.find("components");
    if (components == json.end() || !components->is_array()) return state;
    for (const Json& one : *components) {
        if (one.is_object()) state.components.push_back(componentOf(one));
    }
    return state;
}

}  // namespace

std::vector<StateBudget> readBudget(std::string_view text) {
    const Json budget = Json::parse(text, nullptr, false);
    if (!budget.is_array()) return {};
    std::vector<StateBudget> states;
    for (const Json& one : budget) {
        if (auto state = stateOf(one)) states.push_back(std::move(*state));
    }
    return states;
}

}  // namespace gonio::proc
