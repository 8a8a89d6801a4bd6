#include "daemon/cli/file_facts_json.h"

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/output.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(); }
Json textOrNull(const std::string& text) { return text.empty() ? Json() : Json(text); }

std::string channelText(const proc::Channel& channel) {
    const std::string nm = channel.nanometres ? shortest(*channel.nanometres) + " nm" : "";
    if (channel.name.empty()) return nm.empty() ? "one" : nm;
    return nm.empty() ? channel.name : channel.name + " (" + nm + ")";
}

std::string significant(double value) {
    if (std::isnan(value)) return "";
    std::string text = shortest(static_cast<float>(value));
    return text;
}

Json channelJson(const proc::ChannelFacts& facts) {
    const auto& nm = facts.channel.nanometres;
    return {{"name", textOrNull(facts.channel.name)},
            {"wavelength_nm", nm ? Json(*nm) : Json()},
            {"directions", facts.directions},
            {"measured", facts.measured},
            {"missing", facts.directions - facts.measured},
            {"negative", facts.negative},
            {"least", numberOrNull(facts.least)},
            {"largest", numberOrNull(facts.largest)}};
}

Json totalJson(const proc::TotalFacts& total) {
    return {{"channel", textOrNull(total.channel)},
            {"theta_i_deg", total.incidenceDeg},
            {"phi_i_deg", total.lightAzimuthDeg},
            {"transmission", total.transmission},
            {"stated", total.stated ? Json(*total.stated) : Json()},
            {"recomputed", numberOrNull(total.recomputed)}};
}

std::string sidesOf(const proc::FileFacts& facts) {
    if (facts.reflection && facts.transmission) return "reflection and transmission";
    if (facts.transmission) return "transmission";
    return facts.reflection ? "reflection" : "no values";
}

}  // namespace

Json toJson(const proc::FileFacts& facts) {
    Json channels = Json::array();
    for (const auto& channel : facts.channels) channels.push_back(channelJson(channel));
    Json totals = Json::array();
    for (const auto& total : facts.totals) totals.push_back(totalJson(total));
    Json json = {{"reflection", facts.reflection},
                 {"transmission", facts.transmission},
                 {"symmetry", facts.symmetry},
                 {"light_directions", facts.lights > 0 ? Json(facts.lights) : Json()},
                 {"channels", channels},
                 {"totals", totals}};
    json["theta_o_deg"] =
        facts.thetaOutDeg ? Json::array({facts.thetaOutDeg->from, facts.thetaOutDeg->to}) : Json();
    json["reciprocity"] = Json();
    if (facts.reciprocity) {
        json["reciprocity"] = {{"pairs", facts.reciprocity->pairs},
                               {"median", facts.reciprocity->median},
                               {"p95", facts.reciprocity->p95}};
    }
    json["warnings"] = facts.warnings;
    return json;
}

void printFacts(const proc::FileFacts& facts) {
    std::cout << "sides: " << sidesOf(facts) << "\nsymmetry: " << facts.symmetry << "\n";
    if (facts.thetaOutDeg) {
        std::cout << "views: " << fixed(facts.thetaOutDeg->from, 2) << " to "
                  << fixed(facts.thetaOutDeg->to, 2) << " degrees from the normal\n";
    }
    std::vector<std::vector<std::string>> rows{
        {"channel", "directions", "measured", "negative", "least f", "largest f"}};
    for (const auto& channel : facts.channels) {
        const double all = static_cast<double>(channel.directions);
        rows.push_back({channelText(channel.channel),
                        std::to_string(channel.directions),
                        perCent(static_cast<double>(channel.measured) / all),
                        std::to_string(channel.negative),
                        significant(channel.least),
                        significant(channel.largest)});
    }
    printTable(rows);
    rows = {{"channel", "theta_i", "phi_i", "side", "stated total", "recomputed", "ratio"}};
    for (const auto& total : facts.totals) {
        const bool both = total.stated && total.recomputed > 0;
        rows.push_back({total.channel,
                        shortest(total.incidenceDeg),
                        shortest(total.lightAzimuthDeg),
                        total.transmission ? "through" : "back",
                        total.stated ? fixed(*total.stated, 5) : "",
                        std::isnan(total.recomputed) ? "" : fixed(total.recomputed, 5),
                        both ? fixed(*total.stated / total.recomputed, 3) : ""});
    }
    constexpr std::size_t kPrinted = 40;
    const std::size_t left = rows.size() > kPrinted + 1 ? rows.size() - kPrinted - 1 : 0;
    rows.resize(rows.size() - left);
    if (rows.size() > 1) printTable(rows);
    if (left > 0) std::cout << "and " << left << " more light directions (--json has all)\n";
    if (facts.reciprocity) {
        std::cout << "reciprocity: exchanged pairs differ by " << perCent(facts.reciprocity->median)
                  << " (median), " << perCent(facts.reciprocity->p95) << " (95 %), of "
                  << facts.reciprocity->pairs << "\n";
    }
    for (const std::string& warning : facts.warnings) std::cout << "warning: " << warning << "\n";
}

}  // namespace gonio::daemon
