#include "proc/report/fit_tables.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "proc/core/number_text.h"
#include "proc/report/plot_request.h"
#include "proc/report/report_words.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kMostMisfits = 6;

HtmlCell verdictOf(const Selection& selection, std::size_t at) {
    const RankedFit& one = selection.ranked[at];
    if (!one.fit.usable()) return {std::string(name(one.fit.status)), CellTone::Bad};
    if (selection.chosen == at) return {"chosen", CellTone::Good};
    if (!selection.chosen) return {"misfits", CellTone::Bad};
    return one.rejected ? HtmlCell{"rejected", CellTone::Doubtful} : HtmlCell{"possible"};
}

std::string relativeOr(const std::optional<double>& value) {
    return value ? relativeText(*value) : "not known";
}

/// A parameter of all bands of a fit.
struct Row {
    const FittedParameter* first;
    std::vector<std::string> values;
};

std::string valueOf(const FittedParameter& p) {
    const std::string band = p.band ? std::string(1, "RGB"[index(*p.band)]) + " " : "";
    if (!p.measured) return band + "not measured";
    if (p.atLower || p.atUpper) {
        return band + significant(p.value, 3) + " (held by its " + (p.atLower ? "lower" : "upper") +
               " bound)";
    }
    const double u = std::hypot(p.uRandom, p.uSystematic);
    return band + withExpanded(p.value, std::isfinite(u) ? std::optional(u) : std::nullopt);
}

std::vector<Row> rowsOf(const ModelFit& fit) {
    std::vector<Row> rows;
    for (const FittedParameter& p : fit.parameters) {
        if (rows.empty() || rows.back().first->name != p.name) rows.push_back({&p, {}});
        rows.back().values.push_back(valueOf(p));
    }
    return rows;
}

}  // namespace

HtmlTable fitTable(const Selection& selection) {
    HtmlTable table{.caption = "Families of models, the best first",
                    .head = {"model",
                             "verdict",
                             "parameters",
                             "chi-square per degree of freedom",
                             "error of an incidence left out",
                             "the same of its energy",
                             "BIC"},
                    .rows = {}};
    for (std::size_t at = 0; at < selection.ranked.size(); ++at) {
        const ModelFit& fit = selection.ranked[at].fit;
        const bool usable = fit.usable();
        table.rows.push_back({{fit.family->name()},
                              verdictOf(selection, at),
                              {std::to_string(fit.parameterCount())},
                              {usable ? significant(fit.chiSquarePerDof(), 3) : ""},
                              {usable ? relativeOr(fit.heldOutRms()) : ""},
                              {usable ? relativeOr(fit.heldOutEnergyRms()) : ""},
                              {usable ? fixed(fit.bic(), 0) : fit.message}});
    }
    return table;
}

HtmlTable parameterTable(const Selection& selection) {
    HtmlTable table{.caption = "Parameters, with U (k = 2)",
                    .head = {"model", "parameter", "value", "unit"},
                    .rows = {}};
    for (const RankedFit& one : selection.ranked) {
        if (!one.fit.usable()) continue;
        for (const Row& row : rowsOf(one.fit)) {
            std::string values;
            for (const std::string& value : row.values)
                values += (values.empty() ? "" : "; ") + value;
            table.add({one.fit.family->name(), row.first->name, values, row.first->unit});
        }
    }
    return table;
}

HtmlTable misfitTable(const Selection& selection) {
    const std::size_t shown = std::min(kMostMisfits, selection.worst.size());
    HtmlTable table{.caption =
                        "Where the best fit misses most. What an LED and band share, or a patch of "
                        "directions, is in these "
                        "figures; chi-square above takes it for what the budget says that it is",
                    .head = {"light at",
                             "region",
                             "mean square of (f - model) / u",
                             "f over the model",
                             "values"},
                    .rows = {}};
    for (const Misfit& one : std::span(selection.worst).first(shown)) {
        table.add({degreesLabel(one.incidence),
                   one.region,
                   significant(one.chiSquare, 3),
                   std::isfinite(one.meanRatio) ? significant(one.meanRatio, 3) : "the model is 0",
                   std::to_string(one.values)});
    }
    return table;
}

}  // namespace gonio::proc
