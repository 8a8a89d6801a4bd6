#pragma once
// What an estimator made of a surface, as `info --estimator` says it: the methods between and
// beyond the angles and how wrong each candidate was where it could be asked, the prior's gate, and
// the albedos that follow.

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "daemon/cli/albedo_rows.h"
#include "daemon/estimators.h"

namespace gonio::daemon {

struct EstimatorFacts {
    std::string name;
    /// Empty where the estimator chooses nothing.
    struct Choice {
        std::string between, beyond;
        bool errorsKnown = false;
        std::vector<proc::MethodScore> candidates;
        /// By band; empty where the prior was not asked, or the band not measured.
        std::array<std::optional<proc::PriorGate>, 3> gates;
        bool priorAsked = false;
        bool priorPasses = false;
    };
    std::optional<Choice> choice;
    std::vector<AlbedoRow> albedo;
};

[[nodiscard]] EstimatorFacts estimatorFacts(const Estimated& opened, const std::string& name);

[[nodiscard]] nlohmann::ordered_json toJson(const EstimatorFacts& facts);
/// For people, with tables.
void print(const EstimatorFacts& facts);

}  // namespace gonio::daemon
