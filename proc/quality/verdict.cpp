#include "proc/quality/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kGrades{"ok", "warned", "refused", "not determined"};

std::string digits(double value) {
    if (!std::isfinite(value)) return shortest(value);
    if (value == 0) return "0";
    const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value))));
    return fixed(value, std::clamp(2 - magnitude, 0, 9));
}

Json toJson(const Verdict& verdict) {
    Json json{{"name", verdict.name}, {"grade", std::string(name(verdict.grade))}};
    const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
    const auto& figure = verdict.figure;
    json["value"] = figure ? number(figure->value) : Json();
    json["u"] = figure && figure->u ? number(*figure->u) : Json();
    json["unit"] = figure ? Json(figure->unit) : Json();
    json["limit"] = figure ? number(figure->limit) : Json();
    json["evidence"] = verdict.evidence;
    json["next"] = verdict.next.empty() ? Json() : Json(verdict.next);
    return json;
}

std::string textIn(const Json& json, const char* member) {
    const auto found = json.find(member);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::optional<double> numberIn(const Json& json, const char* member) {
    const auto found = json.find(member);
    if (found == json.end() || !found->is_number()) return std::nullopt;
    return found->get<double>();
}

Grade gradeOf(const std::string& text) {
    const auto found = std::find(kGrades.begin(), kGrades.end(), text);
    return found == kGrades.end() ? Grade::NotDetermined
                                  : static_cast<Grade>(found - kGrades.begin());
}

Verdict fromJson(const Json& json) {
    Verdict verdict{.name = textIn(json, "name"),
                    .grade = gradeOf(textIn(json, "grade")),
                    .figure = {},
                    .evidence = textIn(json, "evidence"),
                    .next = textIn(json, "next")};
    if (const auto value = numberIn(json, "value")) {
        verdict.figure = Figure{.value = *value,
                                .u = numberIn(json, "u"),
                                .unit = textIn(json, "unit"),
                                .limit = numberIn(json, "limit").value_or(std::nan(""))};
    }
    return verdict;
}

/// "tilt: 0.52 degrees (u 0.01 degrees), corrected": what stands before the colon is its name.
Verdict fromFreeText(std::string_view text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) {
        return {.name = "note", .figure = {}, .evidence = std::string(text), .next = {}};
    }
    const std::size_t begin = std::min(text.find_first_not_of(' ', colon + 1), text.size());
    return {.name = std::string(text.substr(0, colon)),
            .figure = {},
            .evidence = std::string(text.substr(begin)),
            .next = {}};
}

}  // namespace

std::string_view name(Grade grade) { return kGrades[static_cast<std::size_t>(grade)]; }

Grade graded(Figure& figure, const Limits& limits) {
    const bool refused = figure.value > limits.refused;
    figure.limit = refused ? limits.refused : limits.warned;
    if (refused) return Grade::Refused;
    return figure.value > limits.warned ? Grade::Warned : Grade::Ok;
}

std::string amount(double value, const std::string& unit) {
    if (unit == "1") return digits(100 * value) + " %";
    return digits(value) + (unit.empty() ? "" : " " + unit);
}

std::string described(const Verdict& verdict) {
    std::string text = verdict.name + ": " + std::string(name(verdict.grade));
    if (verdict.figure) {
        const Figure& figure = *verdict.figure;
        text += ", " + amount(figure.value, figure.unit) + " (";
        if (figure.u) text += "u " + amount(*figure.u, figure.unit) + ", ";
        text += "limit " + amount(figure.limit, figure.unit) + ")";
    }
    text += ": " + verdict.evidence;
    return verdict.next.empty() ? text : text + "; " + verdict.next;
}

std::string verdictsText(std::span<const Verdict> verdicts) {
    Json list = Json::array();
    for (const Verdict& verdict : verdicts) list.push_back(toJson(verdict));
    return list.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<Verdict> readVerdicts(std::string_view text) {
    if (text.empty()) return {};
    const Json list = Json::parse(text, nullptr, false);
    if (!list.is_array()) return {fromFreeText(text)};
    std::vector<Verdict> verdicts;
    for (const Json& one : list) {
        if (one.is_object()) verdicts.push_back(fromJson(one));
    }
    return verdicts;
}

void put(std::vector<Verdict>& verdicts, Verdict verdict) {
    const auto same = std::find_if(verdicts.begin(), verdicts.end(), [&](const Verdict& one) {
        return one.name == verdict.name;
    });
    if (same == verdicts.end()) {
        verdicts.push_back(std::move(verdict));
    } else {
        *same = std::move(verdict);
    }
}

}  // namespace gonio::proc
