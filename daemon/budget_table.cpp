#include "daemon/budget_table.h"

#include <algorithm>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "proc/core/median.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// A component in all states that have it.
using States = std::vector<Json>;

std::optional<double> medianOf(const States& states, const char* key) {
    std::vector<double> values;
    for (const Json& state : states) {
        const auto value = state.find(key);
        if (value != state.end() && value->is_number()) values.push_back(value->get<double>());
    }
    if (values.empty()) return std::nullopt;
    return median(std::move(values));
}

std::string percent(std::optional<double> share) {
    return share ? fixed(100 * *share, 3) + " %" : "";
}

std::string sizeOf(const States& states) {
    const auto size = medianOf(states, "size");
    if (!size) return "";
    return states.front().value("unit", "") == "degree" ? fixed(*size, 4) + " deg" : percent(size);
}

std::string sensitivityOf(const States& states) {
    const auto sensitivity = medianOf(states, "sensitivity");
    return sensitivity ? fixed(*sensitivity, 3) : "";
}

std::string freedomOf(const States& states) {
    const auto freedom = medianOf(states, "freedom");
    return freedom ? fixed(*freedom, 0) : "";
}

void writeRow(std::ostream& out, const std::vector<std::string>& row) {
    constexpr int kWidths[] = {40, 6, 10, 12, 13, 11, 8};
    for (std::size_t i = 0; i < row.size(); ++i) {
        out << (i < 3 ? std::left : std::right) << std::setw(kWidths[i]) << row[i];
    }
    out << "\n";
}

}  // namespace

std::string budgetTable(const Json& budget) {
    std::vector<std::pair<std::string, States>> components;  // in the order of the first state
    for (const Json& state : budget.is_array() ? budget : Json::array()) {
        for (const Json& one : state.value("components", Json::array())) {
            const std::string name = one.value("name", "");
            auto known = std::find_if(components.begin(), components.end(), [&](const auto& c) {
                return c.first == name;
            });
            if (known == components.end()) known = components.insert(known, {name, {}});
            known->second.push_back(one);
        }
    }
    if (components.empty()) return {};
    std::ostringstream out;
    writeRow(out, {"component", "type", "class", "size", "sensitivity", "u(f)/f", "freedom"});
    for (const auto& [name, states] : components) {
        writeRow(out,
                 {name,
                  states.front().value("type", ""),
                  states.front().value("correlation", ""),
                  sizeOf(states),
                  sensitivityOf(states),
                  percent(medianOf(states, "median_relative")),
                  freedomOf(states)});
    }
    return out.str();
}

}  // namespace gonio::daemon
