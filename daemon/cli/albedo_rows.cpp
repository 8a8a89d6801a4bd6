#include "daemon/cli/albedo_rows.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace gonio::daemon {

using Json = nlohmann::ordered_json;

std::vector<AlbedoRow> albedoRows(const Scatterer& surface,
                                  const std::vector<Radians>& incidences) {
    // An estimator takes microseconds for an answer: its albedo is worth a thousandth.
    const proc::AlbedoOptions options{.tolerance = 1e-4, .mostEvaluations = 20000};
    std::vector<AlbedoRow> rows;
    for (const Radians incidence : incidences) {
        const Direction wi = Direction::fromSpherical(incidence, Radians(0));
        rows.push_back({incidence, proc::directionalAlbedo(surface, wi, options)});
    }
    rows.push_back(
        {std::nullopt,
         proc::meanAlbedo(surface,
                          {.directional = options, .tolerance = 1e-3, .mostIncidences = 15})});
    return rows;
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
    return json;
}

}  // namespace gonio::daemon
