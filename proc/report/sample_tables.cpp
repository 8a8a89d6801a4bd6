#include "proc/report/sample_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/quality/verdict.h"
#include "proc/report/plot_request.h"
#include "proc/report/report_words.h"
#include "proc/report/sample_cells.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

std::string lightOf(const SampleSet& sample) {
    std::vector<std::string> labels;
    for (const LedTable& led : sample.leds) {
        const std::string label = degreesLabel(led.incidence);
        if (std::find(labels.begin(), labels.end(), label) == labels.end()) labels.push_back(label);
    }
    std::string text;
    for (const std::string& label : labels) text += (text.empty() ? "" : ", ") + label;
    return text.empty() ? "none" : text + " from the normal, azimuth 0 of the rig";
}

/// How the sample lay on the stage.
std::string turnsOf(const SampleSet& sample) {
    std::string text;
    for (const Radians rotation : rotationsOf(sample)) {
        const std::string label = turnLabel(rotation);
        text += (text.empty() ? "" : ", ") + (label.empty() ? "not turned" : label);
    }
    return text.empty() ? "none" : text;
}

std::string bandsOf(const SampleSet& sample) {
    std::string text;
    for (const Band band : measuredBands(sample))
        text += (text.empty() ? "" : ", ") + bandName(band);
    return text.empty() ? "none" : text + " (the LEDs' own)";
}

std::string wantedAndAchieved(const SampleInfo& info) {
    const auto text = [](const std::optional<double>& u) {
        return u ? relativeText(*u) : orNotSaid("");
    };
    return "wanted " + text(info.requestedUncertainty) + ", median over the cells " +
           text(info.achievedUncertainty) + " (k = 1)";
}

CellTone toneOf(Grade grade) {
    switch (grade) {
        case Grade::Ok: return CellTone::Good;
        case Grade::Warned: return CellTone::Doubtful;
        case Grade::Refused: return CellTone::Bad;
        case Grade::NotDetermined: return CellTone::Plain;
    }
    return CellTone::Plain;
}

std::string limitText(const Verdict& verdict) {
    if (!verdict.figure || !std::isfinite(verdict.figure->limit)) return "";
    return amount(verdict.figure->limit, verdict.figure->unit);
}

/// "9 ok, 1 warned".
std::string verdictSummary(const SampleSet& sample) {
    std::array<int, 4> counts{};
    for (const Verdict& verdict : readVerdicts(sample.info.qcVerdicts))
        ++counts[static_cast<std::size_t>(verdict.grade)];
    std::string text;
    for (std::size_t grade = 0; grade < counts.size(); ++grade) {
        if (counts[grade] == 0) continue;
        text += (text.empty() ? "" : ", ") + std::to_string(counts[grade]) + " " +
                std::string(name(static_cast<Grade>(grade)));
    }
    return text.empty() ? "none" : text;
}

/// Solid angle, as a share of the hemisphere.
struct Shares {
    double measured = 0;
    std::array<double, kFlagCount> flags{};
};

Shares sharesOf(const CellSamples& cells) {
    Shares shares;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const double share = CellGrid::solidAngle(cell) / (2 * kPi);
        if (cells.present(cell)) shares.measured += share;
        for (int flag = 0; flag < kFlagCount; ++flag) {
            if (cells.flags[cell].has(static_cast<Flag>(flag)))
                shares.flags[static_cast<std::size_t>(flag)] += share;
        }
    }
    return shares;
}

}  // namespace

std::string figureText(const Verdict& verdict) {
    if (!verdict.figure) return "";
    const Figure& figure = *verdict.figure;
    if (!figure.u) return amount(figure.value, figure.unit);
    const bool fraction = figure.unit == "1";
    const double scale = fraction ? 100 : 1;
    return "(" + withExpanded(scale * figure.value, scale * *figure.u) + ") " +
           (fraction ? "%" : figure.unit);
}

Facts identityFacts(const SampleSet& sample, const ReportOrigin& origin) {
    const SampleInfo& info = sample.info;
    Facts facts{
        {"sample", orNotSaid(info.name)},
        {"measured (UTC)", orNotSaid(info.dateUtc)},
        {"rig", orNotSaid(info.rigSerial)},
        {"operator", orNotSaid(origin.operatorName)},
        {"session", orNotSaid(info.session)},
        {"notes", orNotSaid(info.operatorNotes)},
        {"light", lightOf(sample)},
        {"sample on the stage", turnsOf(sample)},
        {"view", "outermost value at " + degreesLabel(fieldOf(sample)) + " from the normal"},
        {"bands", bandsOf(sample)},
        {"effort", orNotSaid(info.effort)},
        {"relative uncertainty", wantedAndAchieved(info)},
        {"checks", verdictSummary(sample)},
        {"time",
         fixed(info.rigSeconds, 1) + " s on the rig, " + fixed(info.computeSeconds, 1) +
             " s of computing"},
        {"interruptions", std::to_string(info.interruptions)},
        {"measured by", orNotSaid(info.softwareVersion)},
        {"file", origin.file},
        {"SHA-256 of the file", orNotSaid(origin.digest)},
        {"report made (UTC)", orNotSaid(origin.madeUtc) + " by " + origin.madeBy}};
    if (!info.truthSpec.empty()) facts.emplace_back("lay under a simulated rig", info.truthSpec);
    return facts;
}

Facts furtherFacts(const SampleSet& sample) {
    Facts facts;
    for (const auto& [key, words] : sample.info.extra) {
        const bool fraction = words.find('.') != std::string::npos;
        const auto number = fraction ? parseDouble(words) : std::nullopt;
        const std::string cut = number ? significant(*number, 4) : words;
        facts.emplace_back(key, cut.size() < words.size() ? cut : words);
    }
    return facts;
}

HtmlTable verdictTable(const SampleSet& sample) {
    HtmlTable table{.caption = "Checks of the measurement",
                    .head = {"check", "verdict", "figure", "limit", "evidence", "what to do"},
                    .rows = {}};
    for (const Verdict& verdict : readVerdicts(sample.info.qcVerdicts)) {
        table.rows.push_back({{verdict.name},
                              {std::string(name(verdict.grade)), toneOf(verdict.grade)},
                              {figureText(verdict)},
                              {limitText(verdict)},
                              {verdict.evidence},
                              {verdict.next.empty() ? "nothing" : verdict.next}});
    }
    return table;
}

HtmlTable coverageTable(const SampleSet& sample) {
    std::vector<std::pair<std::string, Shares>> states;
    Shares any;
    for (const LedTable& led : sample.leds) {
        for (const Band band : kBands) {
            const CellSamples* cells = cellsOf(led, band);
            if (cells == nullptr) continue;
            states.emplace_back(lightLabel(led) + ", " + bandName(band), sharesOf(*cells));
            for (std::size_t i = 0; i < any.flags.size(); ++i)
                any.flags[i] += states.back().second.flags[i];
        }
    }
    HtmlTable table{.caption = "Shares of the hemisphere's solid angle",
                    .head = {"light at, band", "measured", "missing"},
                    .rows = {}};
    const auto shown = [&](int flag) {
        return static_cast<Flag>(flag) != Flag::Measured &&
               any.flags[static_cast<std::size_t>(flag)] > 0;
    };
    for (int flag = 0; flag < kFlagCount; ++flag) {
        if (shown(flag)) table.head.emplace_back(name(static_cast<Flag>(flag)));
    }
    for (const auto& [state, shares] : states) {
        std::vector<std::string> row{
            state, shareText(shares.measured), shareText(1 - shares.measured)};
        for (int flag = 0; flag < kFlagCount; ++flag) {
            if (shown(flag)) row.push_back(shareText(shares.flags[static_cast<std::size_t>(flag)]));
        }
        table.add(row);
    }
    return table;
}

}  // namespace gonio::proc
