#include "proc/table/merged_info.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kBetween = "; ";

/// Each text once, in order, without the empty ones.
std::string joined(std::span<const SampleInfo> parts, std::string SampleInfo::*field) {
    std::vector<std::string> seen;
    std::string all;
    for (const SampleInfo& part : parts) {
        const std::string& text = part.*field;
        if (text.empty() || std::find(seen.begin(), seen.end(), text) != seen.end()) continue;
        seen.push_back(text);
        all += (all.empty() ? "" : kBetween) + text;
    }
    return all;
}

/// The parts' own entries, where all that have one agree.
std::map<std::string, std::string> commonExtra(std::span<const SampleInfo> parts) {
    std::map<std::string, std::string> extra;
    for (const SampleInfo& part : parts) extra.insert(part.extra.begin(), part.extra.end());
    for (const SampleInfo& part : parts) {
        for (const auto& [key, value] : part.extra) {
            const auto kept = extra.find(key);
            if (kept != extra.end() && kept->second != value) extra.erase(kept);
        }
    }
    return extra;
}

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Array of states; empty where it is none.
Json statesOf(const std::string& budgetJson) {
    Json budget = Json::parse(budgetJson, nullptr, false);
    if (!budget.is_array()) return Json::array();
    Json states = Json::array();
    for (Json& state : budget) {
        const bool good = state.is_object() && state.contains("led") &&
                          state["led"].is_number_unsigned() && state.contains("band") &&
                          state["band"].is_string();
        if (good) states.push_back(std::move(state));
    }
    return states;
}

std::string textOf(const Json& states) { return states.empty() ? "" : dumped(states); }

/// Empty where there is no text of that name.
std::string textIn(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

bool isNoise(const Json& component) {
    return textIn(component, "correlation") == "per cell" && textIn(component, "type") == "A";
}

/// The component of this name and a size.
const Json* sizedComponent(const Json& state, const std::string& name) {
    const auto components = state.find("components");
    if (components == state.end() || !components->is_array()) return nullptr;
    for (const Json& one : *components) {
        if (!one.is_object() || textIn(one, "name") != name) continue;
        const auto size = one.find("median_relative");
        return size != one.end() && size->is_number() ? &one : nullptr;
    }
    return nullptr;
}

/// The first with its components' sizes at their means over all that have them.
Json meanState(std::span<const Json> states, double random) {
    Json mean = states.front();
    const auto components = mean.find("components");
    if (components == mean.end() || !components->is_array()) return mean;
    for (Json& one : *components) {
        if (!one.is_object()) continue;
        double sum = 0, count = 0;
        for (const Json& state : states) {
            const Json* const same = sizedComponent(state, textIn(one, "name"));
            if (same == nullptr) continue;
            sum += (*same)["median_relative"].get<double>();
            ++count;
        }
        if (count > 0) one["median_relative"] = sum / count * (isNoise(one) ? random : 1);
    }
    return mean;
}

/// Of the tables `kept` of a set, numbered anew in that order.
std::string budgetOfTables(const std::string& budgetJson, std::span<const std::size_t> kept) {
    const Json states = statesOf(budgetJson);
    Json all = Json::array();
    for (std::size_t to = 0; to < kept.size(); ++to) {
        for (const Json& state : states) {
            if (state["led"].get<std::size_t>() != kept[to]) continue;
            Json moved = state;
            moved["led"] = to;
            all.push_back(std::move(moved));
        }
    }
    return textOf(all);
}

}  // namespace

bool ofSeveral(const std::string& text) { return text.find(kBetween) != std::string::npos; }

SampleInfo mergedInfo(std::span<const SampleInfo> parts, const std::string& how) {
    SampleInfo info = parts.front();
    for (const auto field : {&SampleInfo::name,
                             &SampleInfo::rigSerial,
                             &SampleInfo::profileHash,
                             &SampleInfo::calibrationId,
                             &SampleInfo::session,
                             &SampleInfo::operatorNotes,
                             &SampleInfo::softwareVersion,
                             &SampleInfo::effort,
                             &SampleInfo::referenceCertificate}) {
        info.*field = joined(parts, field);
    }
    info.qcVerdicts.clear();
    info.rigSeconds = info.computeSeconds = 0;
    info.interruptions = 0;
    info.extra = commonExtra(parts);
    Json from = Json::array();
    for (const SampleInfo& part : parts) {
        info.rigSeconds += part.rigSeconds;
        info.computeSeconds += part.computeSeconds;
        info.interruptions += part.interruptions;
        info.dateUtc = std::max(info.dateUtc, part.dateUtc);
        if (part.truthSpec != info.truthSpec) info.truthSpec.clear();
        if (part.requestedUncertainty != info.requestedUncertainty)
            info.requestedUncertainty.reset();
        from.push_back({{"name", part.name}, {"date", part.dateUtc}});
    }
    info.extra["merged"] = dumped({{"how", how}, {"from", from}});
    return info;
}

std::string joinedBudget(std::span<const SampleSet> sets) {
    Json all = Json::array();
    std::size_t tables = 0;
    for (const SampleSet& set : sets) {
        for (Json& state : statesOf(set.info.budgetJson)) {
            const auto led = state["led"].get<std::size_t>();
            if (led >= set.leds.size()) continue;
            state["led"] = tables + led;
            all.push_back(std::move(state));
        }
        tables += set.leds.size();
    }
    return textOf(all);
}

SampleSet tablesAt(const SampleSet& set, Radians rotation) {
    SampleSet part{.info = set.info, .leds = {}};
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < set.leds.size(); ++i) {
        if (!sameRotation(set.leds[i].rotation, rotation)) continue;
        kept.push_back(i);
        part.leds.push_back(set.leds[i]);
    }
    part.info.budgetJson = budgetOfTables(set.info.budgetJson, kept);
    return part;
}

std::string budgetOfChannels(const SampleSet& merged, std::span<const SampleSet> bands) {
    Json all = Json::array();
    for (std::size_t to = 0; to < merged.leds.size(); ++to) {
        for (const SampleSet& band : bands) {
            for (Json& state : statesOf(band.info.budgetJson)) {
                const auto from = state["led"].get<std::size_t>();
                if (from >= band.leds.size()) continue;
                if (!sameLight(band.leds[from], merged.leds[to])) continue;
                state["led"] = to;
                all.push_back(std::move(state));
            }
        }
    }
    return textOf(all);
}

std::string averagedBudget(const SampleSet& average,
                           std::span<const SampleSet> captures,
                           double random) {
    std::vector<Json> budgets;
    for (const SampleSet& set : captures) budgets.push_back(statesOf(set.info.budgetJson));
    Json all = Json::array();
    for (std::size_t to = 0; to < average.leds.size(); ++to) {
        for (const Band band : kBands) {
            std::vector<Json> states;
            for (std::size_t c = 0; c < captures.size(); ++c) {
                for (const Json& state : budgets[c]) {
                    const auto from = state["led"].get<std::size_t>();
                    if (from >= captures[c].leds.size() || state["band"] != letter(band)) continue;
                    const Radians incidence = captures[c].leds[from].incidence;
                    if (!sameIncidence(incidence, average.leds[to].incidence)) continue;
                    states.push_back(state);
                }
            }
            if (states.empty()) continue;
            all.push_back(meanState(states, random));
            all.back()["led"] = to;
        }
    }
    return textOf(all);
}

}  // namespace gonio::proc
