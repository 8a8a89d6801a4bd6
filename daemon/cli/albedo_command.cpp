// `gonio albedo F`.

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/albedo_rows.h"
#include "daemon/cli/commands.h"
#include "daemon/cli/incidence_list.h"
#include "daemon/cli/output.h"
#include "daemon/estimators.h"
#include "proc/core/number_text.h"
#include "proc/estimate/sample_albedo.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// What the cells of the sample hold, without anything in between or beyond.
std::vector<AlbedoRow> ofCells(const proc::SampleSet& sample) {
    std::vector<AlbedoRow> rows;
    for (const proc::LedTable& led : sample.leds) {
        rows.push_back({led.incidence, proc::directionalAlbedo(led)});
    }
    rows.push_back({std::nullopt, proc::meanAlbedo(sample)});
    return rows;
}

std::string shown(const std::optional<double>& value) {
    return value && !std::isnan(*value) ? fixed(*value, 5) : "";
}

std::vector<std::vector<std::string>> tableOf(const std::vector<AlbedoRow>& rows) {
    std::vector<std::vector<std::string>> table{
        {"incidence", "band", "albedo", "u_random", "u_systematic", "error bound", "missing"}};
    for (const AlbedoRow& row : rows) {
        for (const Band band : kBands) {
            const proc::BandAlbedo& one = row.albedo[band];
            table.push_back({row.incidence ? fixed(row.incidence->degrees(), 1) : "mean",
                             std::string(letter(band)),
                             shown(one.value),
                             shown(one.uRandom),
                             shown(one.uSystematic),
                             shown(one.errorBound),
                             perCent(one.missing)});
        }
    }
    return table;
}

}  // namespace

Result<void> albedo(const CommonOptions& common, const AlbedoOptions& options) {
    const Result<Estimated> opened =
        openEstimated(options.file, common.store, {.name = options.estimator});
    if (!opened) return opened.error().in("albedo");
    const proc::SampleSet* sample = opened->material.sample;
    const bool cells = sample != nullptr && options.estimator == "none";
    if (cells && !options.incidences.empty()) {
        return Error{ErrorKind::Usage,
                     "albedo: --estimator none sums the cells of the LEDs' own incidences; leave "
                     "--incidences out"};
    }
    const auto incidences = options.incidences.empty() ? Result(opened->material.incidences())
                                                       : incidenceList(options.incidences);
    if (!incidences) return incidences.error().in("albedo");
    const auto rows = cells ? ofCells(*sample) : albedoRows(*opened->scatterer, *incidences);
    if (common.json) {
        Json all = Json::array();
        for (const AlbedoRow& row : rows) all.push_back(albedoJson(row));
        printJson({{"schema", "gonio/albedo/1"},
                   {"file", options.file},
                   {"estimator", options.estimator},
                   {"rows", all}});
        return {};
    }
    printTable(tableOf(rows));
    return {};
}

}  // namespace gonio::daemon
