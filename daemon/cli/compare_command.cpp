// `gonio compare A B`.

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/incidence_list.h"
#include "daemon/cli/output.h"
#include "daemon/estimators.h"
#include "proc/core/number_text.h"
#include "proc/estimate/comparison.h"
#include "proc/formats/file_degrees.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
using proc::Difference;

std::string shown(double fraction) { return std::isnan(fraction) ? "" : perCent(fraction); }

std::vector<std::vector<std::string>> tableOf(const std::vector<Difference>& rows) {
    std::vector<std::vector<std::string>> table{{"incidence",
                                                 "region",
                                                 "band",
                                                 "values",
                                                 "only one",
                                                 "relative rms",
                                                 "mean",
                                                 "log rms",
                                                 "cosine rms",
                                                 "within 2 u"}};
    for (const Difference& row : rows) {
        table.push_back({shortest(proc::fileDegrees(row.incidence)),
                         row.region,
                         std::string(letter(row.band)),
                         std::to_string(row.values),
                         std::to_string(row.oneOnly),
                         shown(row.relativeRms),
                         shown(row.relativeMean),
                         std::isnan(row.logRms) ? "" : fixed(row.logRms, 4),
                         shown(row.cosineRms),
                         shown(row.within2u)});
    }
    return table;
}

Json toJson(const Difference& row) {
    const auto number = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
    return {{"incidence_deg", proc::fileDegrees(row.incidence)},
            {"region", row.region},
            {"band", letter(row.band)},
            {"values", row.values},
            {"only_one", row.oneOnly},
            {"stated", row.stated},
            {"relative_rms", number(row.relativeRms)},
            {"relative_mean", number(row.relativeMean)},
            {"log_rms", number(row.logRms)},
            {"cosine_rms", number(row.cosineRms)},
            {"within_2u", number(row.within2u)},
            {"mean_square_over_u", number(row.meanSquareOverU)}};
}

}  // namespace

Result<void> compare(const CommonOptions& common, const CompareOptions& options) {
    const auto open = [&](const std::string& f) {
        // A formula answers everywhere: it needs no method. Scattered values have but one.
        const bool scattered = options.estimator.empty() && holdsScattered(f);
        if (scattered || f.starts_with("model:")) return openEstimated(f, common.store, {});
        const bool named = !options.estimator.empty();
        return openEstimated(f, common.store, {.name = named ? options.estimator : "none"});
    };
    const Result<Estimated> a = open(options.a);
    if (!a) return a.error().in("compare");
    const Result<Estimated> b = open(options.b);
    if (!b) return b.error().in("compare");
    const auto incidences =
        options.incidences.empty() ? Result(a->incidences()) : incidenceList(options.incidences);
    if (!incidences) return incidences.error().in("compare");
    const auto rows = proc::compareSurfaces(*a->scatterer, *b->scatterer, *incidences);
    if (rows.empty()) {
        return Error{ErrorKind::Quality,
                     "compare: '" + options.a + "' and '" + options.b +
                         "' answer at no common direction of these incidences; --incidences or "
                         "--estimator auto may help"};
    }
    const proc::Agreement agreement = proc::agreementOf(rows);
    if (common.json) {
        Json all = Json::array();
        for (const Difference& row : rows) all.push_back(toJson(row));
        printJson({{"schema", "gonio/compare/1"},
                   {"a", options.a},
                   {"b", options.b},
                   {"agreement", name(agreement)},
                   {"rows", all}});
        return {};
    }
    printTable(tableOf(rows));
    switch (agreement) {
        case proc::Agreement::Agree:
            std::cout << "They agree: 90 % or more of the values lie within twice their u.\n";
            break;
        case proc::Agreement::Disagree: std::cout << "They do not agree within their u.\n"; break;
        case proc::Agreement::Unknown:
            std::cout << "Whether they agree cannot be said: too few values have an uncertainty.\n";
            break;
    }
    return {};
}

}  // namespace gonio::daemon
