#include "proc/report/calibration_tables.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "proc/calibrate/budget_text.h"
#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/report/report_words.h"
#include "proc/report/sample_tables.h"

namespace gonio::proc {
namespace {

constexpr double kHoursOfDay = 24;

std::string spanText(double hours) {
    if (hours < 1) return fixed(hours * 60, 0) + " min";
    return hours < 2 * kHoursOfDay ? fixed(hours, 1) + " h"
                                   : fixed(hours / kHoursOfDay, 1) + " days";
}

std::string ageText(const std::optional<double>& hours) {
    if (!hours) return "not known";
    // `recalibrate` may take one that was made later.
    if (*hours < 0) return spanText(-*hours) + " after the measurement";
    return spanText(*hours);
}

bool isWhite(const std::string& name) { return name.rfind("white reference", 0) == 0; }
/// "black reference", "zero reference": whichever the sample was worked out with.
bool isLower(const std::string& name) {
    constexpr std::string_view kReference = " reference";
    return !isWhite(name) && name.size() > kReference.size() &&
           name.compare(name.size() - kReference.size(), kReference.size(), kReference) == 0;
}
bool isDrift(const std::string& name) { return name.find("drift") != std::string::npos; }

/// Sizes of the components of type B with such names: the median over the states that say one.
std::string sizesOf(const SampleSet& sample, bool (*wanted)(const std::string& name)) {
    struct Sizes {
        std::string name, unit;
        std::vector<double> values;
    };
    std::vector<Sizes> all;
    for (const StateBudget& state : readBudget(sample.info.budgetJson)) {
        for (const BudgetComponent& one : state.components) {
            if (one.type != 'B' || !(one.size > 0) || !wanted(one.name)) continue;
            auto own = std::find_if(all.begin(), all.end(), [&](const Sizes& known) {
                return known.name == one.name && known.unit == one.unit;
            });
            if (own == all.end()) own = all.insert(own, {one.name, one.unit, {}});
            own->values.push_back(one.size);
        }
    }
    std::string text;
    for (const Sizes& one : all)
        text +=
            (text.empty() ? "" : "; ") + one.name + " " + sizeText(median(one.values), one.unit);
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
                {"its uncertainty", sizesOf(sample, isWhite)},
                {"uncertainty of the lower reference", sizesOf(sample, isLower)},
                {"rig profile", orNotSaid(info.profileHash)},
                {"drift while measuring", driftText(info)},
                {"drift between captures", sizesOf(sample, isDrift)}};
    if (const auto check = info.extra.find("black_check"); check != info.extra.end())
        facts.emplace_back("black against the zero reference", check->second);
    return facts;
}

}  // namespace gonio::proc
