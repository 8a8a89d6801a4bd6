// `gonio albedo F`.

#include <nlohmann/json.hpp>

#include "daemon/cli/albedo_rows.h"
#include "daemon/cli/commands.h"
#include "daemon/cli/incidence_list.h"
#include "daemon/cli/output.h"
#include "daemon/estimators.h"
#include "proc/estimate/sample_albedo.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// What the cells of the sample hold, without anything in between or beyond.
std::vector<AlbedoRow> ofCells(const proc::SampleSet& sample) {
    std::vector<AlbedoRow> rows;
    for (const proc::LedTable& led : sample.leds) {
        rows.push_back({led.incidence, led.rotation, proc::directionalAlbedo(led)});
    }
    rows.push_back({std::nullopt, Radians(), proc::meanAlbedo(sample)});
    return rows;
}

}  // namespace

Result<void> albedo(const CommonOptions& common, const AlbedoOptions& options) {
    const Result<Effort> effort = parseEffort(options.effort);
    if (!effort) return effort.error().in("albedo");
    const Result<Estimated> opened =
        openEstimated(options.file, common.store, {.name = options.estimator, .effort = *effort});
    if (!opened) return opened.error().in("albedo");
    const proc::SampleSet* sample = opened->material.sample;
    const bool cells = sample != nullptr && options.estimator == "none";
    if (cells && !options.incidences.empty()) {
        return Error{ErrorKind::Usage,
                     "albedo: --estimator none sums the cells of the LEDs' own incidences; leave "
                     "--incidences out"};
    }
    const auto incidences = options.incidences.empty() ? Result(opened->incidences())
                                                       : incidenceList(options.incidences);
    if (!incidences) return incidences.error().in("albedo");
    const auto rows =
        cells ? ofCells(*sample)
              : albedoRows(*opened->scatterer,
                           {.incidences = *incidences, .rotations = opened->rotations()},
                           *effort);
    if (common.json) {
        Json all = Json::array();
        for (const AlbedoRow& row : rows) all.push_back(albedoJson(row));
        printJson({{"schema", "gonio/albedo/1"},
                   {"file", options.file},
                   {"estimator", options.estimator},
                   {"effort", name(*effort)},
                   {"rows", all}});
        return {};
    }
    printTable(albedoTable(rows));
    return {};
}

}  // namespace gonio::daemon
