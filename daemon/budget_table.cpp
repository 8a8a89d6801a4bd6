#include "daemon/budget_table.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>

#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/report/report_words.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// A component in all states that have it.
using States = std::vector<proc::BudgetComponent>;

/// Of what is said; `of` gives an optional.
template <class Of>
std::optional<double> medianOf(const States& states, const Of& of) {
    std::vector<double> values;
    for (const proc::BudgetComponent& state : states) {
        if (const std::optional<double> value = of(state)) values.push_back(*value);
    }
    if (values.empty()) return std::nullopt;
    return median(std::move(values));
}

std::optional<double> effect(const proc::BudgetComponent& one) {
    return std::isfinite(one.medianRelative) ? std::optional(one.medianRelative) : std::nullopt;
}
std::optional<double> size(const proc::BudgetComponent& one) {
    return one.size > 0 ? std::optional(one.size) : std::nullopt;
}
std::optional<double> sensitivity(const proc::BudgetComponent& one) {
    return size(one) && effect(one) ? std::optional(one.sensitivity()) : std::nullopt;
}

std::string percent(std::optional<double> share) {
    return share ? fixed(100 * *share, 3) + " %" : "";
}

std::string sizeOf(const States& states) {
    const auto middle = medianOf(states, size);
    if (!middle) return "";
    const std::string& unit = states.front().unit;
    if (unit == "relative") return percent(middle);
    if (unit == "degree") return fixed(*middle, 4) + " deg";
    return proc::significant(*middle, 3) + " " + unit;
}

std::string numberOf(std::optional<double> value, int decimals) {
    return value ? fixed(*value, decimals) : "";
}

void writeRow(std::ostream& out, const std::vector<std::string>& row) {
    constexpr int kWidths[] = {40, 6, 10, 12, 13, 11, 8};
    for (std::size_t i = 0; i < row.size(); ++i) {
        out << (i < 3 ? std::left : std::right) << std::setw(kWidths[i]) << row[i];
    }
    out << "\n";
}

Json toJson(const proc::BudgetComponent& one) {
    Json json{{"name", one.name},
              {"type", std::string(1, one.type)},
              {"correlation", proc::name(one.correlation)},
              {"median_relative", effect(one) ? Json(one.medianRelative) : Json()}};
    if (!size(one)) return json;
    json["size"] = one.size;
    json["unit"] = one.unit;
    if (const auto change = sensitivity(one)) json["sensitivity"] = *change;
    json["freedom"] = one.freedom ? Json(*one.freedom) : Json();
    return json;
}

}  // namespace

std::string budgetTable(const std::vector<proc::StateBudget>& budget) {
    std::vector<std::pair<std::string, States>> components;  // in the order of the first state
    for (const proc::StateBudget& state : budget) {
        for (const proc::BudgetComponent& one : state.components) {
            auto known = std::find_if(components.begin(), components.end(), [&](const auto& c) {
                return c.first == one.name;
            });
            if (known == components.end()) known = components.insert(known, {one.name, {}});
            known->second.push_back(one);
        }
    }
    if (components.empty()) return {};
    std::ostringstream out;
    writeRow(out, {"component", "type", "class", "size", "sensitivity", "u(f)/f", "freedom"});
    for (const auto& [name, states] : components) {
        const auto freedom = [](const proc::BudgetComponent& one) { return one.freedom; };
        writeRow(out,
                 {name,
                  std::string(1, states.front().type),
                  std::string(proc::name(states.front().correlation)),
                  sizeOf(states),
                  numberOf(medianOf(states, sensitivity), 3),
                  percent(medianOf(states, effect)),
                  numberOf(medianOf(states, freedom), 0)});
    }
    return out.str();
}

Json budgetJson(const std::vector<proc::StateBudget>& budget) {
    Json states = Json::array();
    for (const proc::StateBudget& state : budget) {
        Json components = Json::array();
        for (const proc::BudgetComponent& one : state.components) components.push_back(toJson(one));
        states.push_back({{"led", state.led},
                          {"band", std::string(letter(state.band))},
                          {"monte_carlo_cells", state.monteCarloCells},
                          {"components", components}});
    }
    return states;
}

}  // namespace gonio::daemon
