#include "daemon/cli/estimator_facts.h"

#include <nlohmann/json.hpp>

#include "daemon/cli/albedo_rows.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json scoreJson(const proc::MethodScore& score) {
    return {{"method", score.name},
            {"relative_error_hemisphere", score.hemisphere},
            {"relative_error_lobe", score.lobe},
            {"relative_error_beyond", score.beyond ? Json(*score.beyond) : Json()}};
}

/// Of each band that was measured.
Json gateJson(const proc::SamplePrior& prior) {
    Json bands = Json::object();
    for (const Band band : kBands) {
        const auto& gate = prior.gates()[index(band)];
        if (!gate) continue;
        bands[std::string(letter(band))] = {{"chi_square", gate->chiSquare},
                                            {"predicted_incidences", gate->predicted}};
    }
    return {{"passes", prior.passes()}, {"bands", std::move(bands)}};
}

}  // namespace

Json estimatorFacts(const Estimated& opened, const std::string& name) {
    Json json{{"name", name}};
    if (opened.sample != nullptr) {
        const proc::MethodChoice& choice = opened.sample->choice();
        json["between"] = choice.between.method->name();
        json["beyond"] = choice.beyond.method->name();
        json["errors_known"] = choice.between.errorsKnown;
        json["candidates"] = Json::array();
        for (const proc::MethodScore& score : choice.scores) {
            json["candidates"].push_back(scoreJson(score));
        }
        const proc::SamplePrior* prior = opened.sample->prior();
        json["prior"] = prior != nullptr ? gateJson(*prior) : Json();
    }
    json["albedo"] = Json::array();
    for (const AlbedoRow& row :
         albedoRows(*opened.scatterer, opened.material.incidences(), Effort::Standard)) {
        json["albedo"].push_back(albedoJson(row));
    }
    return json;
}

}  // namespace gonio::daemon
