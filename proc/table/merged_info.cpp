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

/// The component of this name in the same state of another budget.
const Json* sameComponent(const Json& states, const Json& state, const Json& component) {
    for (const Json& other : states) {
        if (other["led"] != state["led"] || other["band"] != state["band"]) continue;
        const auto components = other.find("components");
        if (components == other.end() || !components->is_array()) return nullptr;
        for (const Json& one : *components) {
            if (one.is_object() && one.value("name", "") == component.value("name", ""))
                return &one;
        }
    }
    return nullptr;
}

bool isNoise(const Json& component) {
    return component.value("correlation", "") == "per cell" && component.value("type", "") == "A";
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

SampleSet tablesAt(const SampleSet& set, Radians rotation) {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < set.leds.size(); ++i) {
        if (sameRotation(set.leds[i].rotation, rotation)) kept.push_back(i);
    }
    SampleSet part = atRotation(set, rotation);
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

std::string averagedBudget(std::span<const SampleSet> captures, double random) {
    Json states = statesOf(captures.front().info.budgetJson);
    std::vector<Json> others;
    for (const SampleSet& set : captures.subspan(1))
        others.push_back(statesOf(set.info.budgetJson));
    for (Json& state : states) {
        const auto components = state.find("components");
        if (components == state.end() || !components->is_array()) continue;
        for (Json& one : *components) {
            if (!one.is_object() || !one.contains("median_relative") ||
                !one["median_relative"].is_number())
                continue;
            double sum = one["median_relative"].get<double>(), count = 1;
            for (const Json& other : others) {
                const Json* const same = sameComponent(other, state, one);
                if (same == nullptr || !same->contains("median_relative")) continue;
                if (!(*same)["median_relative"].is_number()) continue;
                sum += (*same)["median_relative"].get<double>();
                count += 1;
            }
            one["median_relative"] = sum / count * (isNoise(one) ? random : 1);
        }
    }
    return textOf(states);
}

}  // namespace gonio::proc
