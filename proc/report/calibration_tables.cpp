#include "proc/report/calibration_tables.h"

#include <algorithm>

#include "proc/calibrate/budget_text.h"
#include "proc/core/number_text.h"
#include "proc/report/report_words.h"
#include "proc/report/sample_tables.h"

namespace gonio::proc {
namespace {

constexpr double kHoursOfDay = 24;

std::string ageText(const std::optional<double>& hours) {
    if (!hours) return "not known";
    if (*hours < 1) return fixed(*hours * 60, 0) + " min";
    return *hours < 2 * kHoursOfDay ? fixed(*hours, 1) + " h"
                                    : fixed(*hours / kHoursOfDay, 1) + " days";
}

/// Sizes of the components with these words in their names, each once.
std::string sizesOf(const SampleSet& sample, std::string_view words) {
    std::string text;
    std::vector<std::string> seen;
    for (const StateBudget& state : readBudget(sample.info.budgetJson)) {
        for (const BudgetComponent& one : state.components) {
            const bool wanted = one.name.find(words) != std::string::npos && one.size > 0 &&
                                one.unit == "relative" && one.type == 'B';
            if (!wanted || std::find(seen.begin(), seen.end(), one.name) != seen.end()) continue;
            seen.push_back(one.name);
            text += (text.empty() ? "" : "; ") + one.name + " " + relativeText(one.size);
        }
    }
    return text.empty() ? std::string("no budget says") : text + " (k = 1)";
}

std::string driftText(const SampleInfo& info) {
    for (const Verdict& verdict : readVerdicts(info.qcVerdicts)) {
        if (verdict.name != "drift") continue;
        const std::string figure = figureText(verdict);
        return std::string(name(verdict.grade)) + ", " + figure + (figure.empty() ? "" : ": ") +
               verdict.evidence;
    }
    return "not looked for";
}

}  // namespace

HtmlTable calibrationTable(const SampleSet& sample, const ReportOrigin& origin) {
    HtmlTable table{.caption = "Calibrations that the sample was worked out with",
                    .head = {"calibration",
                             "number",
                             "taken (UTC)",
                             "age when the sample was measured",
                             "LED board",
                             "rig profile"},
                    .rows = {}};
    for (const ReportedCalibration& one : origin.calibrations) {
        const bool same = one.profileHash == sample.info.profileHash;
        table.add({one.kind,
                   std::to_string(one.number),
                   orNotSaid(one.dateUtc),
                   ageText(one.ageHours),
                   one.celsius ? fixed(*one.celsius, 1) + " degC" : "not known",
                   one.profileHash.empty() ? "not known"
                   : same                  ? "the sample's"
                                           : one.profileHash});
    }
    return table;
}

Facts calibrationFacts(const SampleSet& sample) {
    const SampleInfo& info = sample.info;
    Facts facts{{"calibrations", orNotSaid(info.calibrationId)},
                {"certificate of the white reference", orNotSaid(info.referenceCertificate)},
                {"its uncertainty", sizesOf(sample, "white")},
                {"uncertainty of the lower reference", sizesOf(sample, "black reference")},
                {"rig profile", orNotSaid(info.profileHash)},
                {"drift while measuring", driftText(info)},
                {"drift between captures", sizesOf(sample, "drift")}};
    if (const auto check = info.extra.find("black_check"); check != info.extra.end())
        facts.emplace_back("black against the zero reference", check->second);
    return facts;
}

}  // namespace gonio::proc
