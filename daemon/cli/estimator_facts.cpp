#include "daemon/cli/estimator_facts.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/output.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
using Choice = EstimatorFacts::Choice;

Choice choiceOf(const proc::SampleEstimator& sample) {
    const proc::MethodChoice& chosen = sample.choice();
    Choice choice{.between = chosen.between.method->name(),
                  .beyond = chosen.beyond.method->name(),
                  .errorsKnown = chosen.between.errorsKnown,
                  .candidates = chosen.scores,
                  .gates = {}};
    if (const proc::SamplePrior* prior = sample.prior()) {
        choice.gates = prior->gates();
        choice.priorAsked = true;
        choice.priorPasses = prior->passes();
    }
    return choice;
}

Json scoreJson(const proc::MethodScore& score) {
    return {{"method", score.name},
            {"relative_error_hemisphere", score.hemisphere},
            {"relative_error_lobe", score.lobe},
            {"relative_error_beyond", score.beyond ? Json(*score.beyond) : Json()}};
}

/// Of each band that was measured.
Json gateJson(const Choice& choice) {
    if (!choice.priorAsked) return {};
    Json bands = Json::object();
    for (const Band band : kBands) {
        const auto& gate = choice.gates[index(band)];
        if (!gate) continue;
        bands[std::string(letter(band))] = {{"chi_square", gate->chiSquare},
                                            {"predicted_incidences", gate->predicted}};
    }
    return {{"passes", choice.priorPasses}, {"bands", std::move(bands)}};
}

std::string gateText(const Choice& choice) {
    if (!choice.priorAsked) return "not asked";
    std::string text = choice.priorPasses ? "of its kind; chi-square" : "refused; chi-square";
    for (const Band band : kBands) {
        const auto& gate = choice.gates[index(band)];
        if (gate) text += " " + std::string(letter(band)) + " " + fixed(gate->chiSquare, 2);
    }
    return text + ", wanted " + fixed(proc::PriorGate::kMost, 2) + " at most";
}

std::vector<std::vector<std::string>> candidateTable(const std::vector<proc::MethodScore>& scores) {
    std::vector<std::vector<std::string>> table{{"method", "hemisphere", "lobe", "beyond"}};
    for (const proc::MethodScore& score : scores) {
        table.push_back({score.name,
                         perCent(score.hemisphere),
                         perCent(score.lobe),
                         score.beyond ? perCent(*score.beyond) : ""});
    }
    return table;
}

}  // namespace

EstimatorFacts estimatorFacts(const Estimated& opened, const std::string& name) {
    EstimatorFacts facts{.name = name, .choice = {}, .albedo = {}};
    if (opened.sample != nullptr) facts.choice = choiceOf(*opened.sample);
    facts.albedo = albedoRows(*opened.scatterer,
                              {.incidences = opened.incidences(), .rotations = opened.rotations()},
                              Effort::Standard);
    return facts;
}

Json toJson(const EstimatorFacts& facts) {
    Json json{{"name", facts.name}};
    if (facts.choice) {
        json["between"] = facts.choice->between;
        json["beyond"] = facts.choice->beyond;
        json["errors_known"] = facts.choice->errorsKnown;
        json["candidates"] = Json::array();
        for (const proc::MethodScore& score : facts.choice->candidates) {
            json["candidates"].push_back(scoreJson(score));
        }
        json["prior"] = gateJson(*facts.choice);
    }
    json["albedo"] = Json::array();
    for (const AlbedoRow& row : facts.albedo) json["albedo"].push_back(albedoJson(row));
    return json;
}

void print(const EstimatorFacts& facts) {
    std::cout << "estimator: " << facts.name << "\n";
    if (facts.choice) {
        std::cout << "  between the angles: " << facts.choice->between << "\n"
                  << "  beyond them: " << facts.choice->beyond << "\n"
                  << "  prior: " << gateText(*facts.choice) << "\n";
        if (facts.choice->errorsKnown) {
            std::cout << "candidates, relative error where parts were left out:\n";
            printTable(candidateTable(facts.choice->candidates));
        } else {
            std::cout << "  errors: not known, nothing could be left out\n";
        }
    }
    std::cout << "albedo:\n";
    printTable(albedoTable(facts.albedo));
}

}  // namespace gonio::daemon
