#include "daemon/cli/albedo_rows.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/estimate/sample_albedo.h"
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
            .mostIncidences = 45};
}

std::string shown(const std::optional<double>& value) {
    return value && !std::isnan(*value) ? fixed(*value, 5) : "";
}

/// A surface as the light sees it that stands at azimuth 0 of a turned sample. Borrows it.
class Turned : public Scatterer {
public:
    Turned(const Scatterer& surface, Radians rotation) : surface_(surface), rotation_(rotation) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        return surface_.answer(
            {.in = pair.in.turned(-rotation_), .out = pair.out.turned(-rotation_)});
    }
    [[nodiscard]] BandCount bandCount() const override { return surface_.bandCount(); }

private:
    const Scatterer& surface_;
    Radians rotation_;
};

}  // namespace

std::vector<AlbedoRow> albedoRows(const Scatterer& surface,
                                  const AlbedoLights& lights,
                                  Effort effort) {
    const proc::MeanAlbedoOptions options = optionsOf(effort);
    const std::size_t count = lights.incidences.size();
    std::vector<AlbedoRow> rows(count * lights.rotations.size());
    parallelFor(rows.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const Radians incidence = lights.incidences[i % count];
            const Radians rotation = lights.rotations[i / count];
            const Direction wi = Direction::fromSpherical(incidence, -rotation);
            rows[i] = {
                incidence, rotation, proc::directionalAlbedo(surface, wi, options.directional)};
        }
    });
    std::vector<proc::Albedo> means;
    for (const Radians rotation : lights.rotations)
        means.push_back(proc::meanAlbedo(Turned(surface, rotation), options));
    rows.push_back({std::nullopt, Radians(), proc::averagedAlbedo(means)});
    return rows;
}

std::vector<std::vector<std::string>> albedoTable(const std::vector<AlbedoRow>& rows) {
    std::vector<std::vector<std::string>> table{{"incidence",
                                                 "rotation",
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
                             row.incidence ? shortest(proc::fileDegrees(row.rotation)) : "",
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
    Json json{
        {"incidence_deg", row.incidence ? Json(proc::fileDegrees(*row.incidence)) : Json(nullptr)},
        {"rotation_deg", row.incidence ? Json(proc::fileDegrees(row.rotation)) : Json(nullptr)}};
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
