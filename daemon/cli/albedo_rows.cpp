#include "daemon/cli/albedo_rows.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/formats/file_degrees.h"

namespace gonio::daemon {

using Json = nlohmann::ordered_json;

namespace {

proc::MeanAlbedoOptions optionsOf(Effort effort) {
    switch (effort) {
        case Effort::Draft:
            return {.directional = {.tolerance = 1e-3, .mostEvaluations = 5400},
                    .tolerance = 1e-2,
                    .mostIncidences = 15};
        case Effort::Reference:
            return {.directional = {.tolerance = 1e-5, .mostEvaluations = 40000},
                    .tolerance = 1e-4,
                    .mostIncidences = 255};
        case Effort::Standard: break;
    }
    // An estimator takes microseconds for an answer: its albedo is worth a thousandth.
    return {.directional = {.tolerance = 1e-4, .mostEvaluations = 20000},
            .tolerance = 1e-3,
            .mostIncidences = 15};
}

std::string shown(const std::optional<double>& value) {
    return value && !std::isnan(*value) ? fixed(*value, 5) : "";
}

}  // namespace

std::vector<AlbedoRow> albedoRows(const Scatterer& surface,
                                  const std::vector<Radians>& incidences,
                                  Effort effort) {
    const proc::MeanAlbedoOptions options = optionsOf(effort);
    std::vector<AlbedoRow> rows(incidences.size());
    parallelFor(rows.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const Direction wi = Direction::fromSpherical(incidences[i], Radians(0));
            rows[i] = {incidences[i], proc::directionalAlbedo(surface, wi, options.directional)};
        }
    });
    rows.push_back({std::nullopt, proc::meanAlbedo(surface, options)});
    return rows;
}

std::vector<std::vector<std::string>> albedoTable(const std::vector<AlbedoRow>& rows) {
    std::vector<std::vector<std::string>> table{{"incidence",
                                                 "band",
                                                 "albedo",
                                                 "u_random",
                                                 "u_systematic",
                                                 "error bound",
                                                 "missing",
                                                 "evaluations",
                                                 "converged"}};
    for (const AlbedoRow& row : rows) {
        for (const Band band : kBands) {
            const proc::BandAlbedo& one = row.albedo[band];
            table.push_back({row.incidence ? shortest(proc::fileDegrees(*row.incidence)) : "mean",
                             std::string(letter(band)),
                             shown(one.value),
                             shown(one.uRandom),
                             shown(one.uSystematic),
                             shown(one.errorBound),
                             perCent(one.missing),
                             std::to_string(row.albedo.evaluations),
                             row.albedo.converged ? "yes" : "no"});
        }
    }
    return table;
}

Json albedoJson(const AlbedoRow& row) {
    const auto number = [](const std::optional<double>& v) {
        return v && std::isfinite(*v) ? Json(*v) : Json(nullptr);
    };
    Json json{{"incidence_deg", row.incidence ? Json(row.incidence->degrees()) : Json(nullptr)}};
    for (const Band band : kBands) {
        const proc::BandAlbedo& one = row.albedo[band];
        json["bands"][std::string(letter(band))] = {{"albedo", number(one.value)},
                                                    {"u_random", number(one.uRandom)},
                                                    {"u_systematic", number(one.uSystematic)},
                                                    {"error_bound", number(one.errorBound)},
                                                    {"missing", one.missing}};
    }
    json["evaluations"] = row.albedo.evaluations;
    json["converged"] = row.albedo.converged;
    return json;
}

}  // namespace gonio::daemon
