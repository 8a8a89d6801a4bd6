#include "daemon/engine/plan_document.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// What is not finite is missing.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json toJson(const proc::Spread& spread) {
    return {{"worst", number(spread.worst)},
            {"p95", number(spread.percentile95)},
            {"median", number(spread.median)}};
}

Json toJson(const proc::TimeParts& parts) {
    return {{"total", parts.total().count()},
            {"exposure", parts.exposure.count()},
            {"readout", parts.readout.count()},
            {"settle", parts.settle.count()},
            {"dark", parts.dark.count()},
            {"pilot", parts.pilot.count()},
            {"latency", parts.latency.count()}};
}

Json toJson(const proc::ShotKind& shot) {
    return {{"level", shot.level}, {"exposure_us", shot.exposure.count() * 1e6}};
}

Json toJson(const proc::StatePlan& state) {
    Json captures = Json::array();
    for (const proc::PlannedCapture& planned : state.captures) {
        Json capture = toJson(planned.shot);
        capture["frames"] = planned.frames;
        captures.push_back(std::move(capture));
    }
    return {{"led", state.led}, {"band", std::string(letter(state.band))}, {"captures", captures}};
}

/// Of the sample, pilots among them.
int framesOf(const proc::Plan& plan) {
    int frames = 0;
    for (std::size_t s = 0; s < plan.states.size(); ++s)
        frames += plan.framesOf(s) + static_cast<int>(plan.pilots.size());
    return frames;
}

Json toJson(const proc::CellCounts& counts) {
    return {{"planned", counts.planned},
            {"below_range", counts.belowRange},
            {"saturated", counts.saturated},
            {"too_dim", counts.tooDim},
            {"no_signal", counts.noSignal},
            {"ignored", counts.ignored},
            {"held_at_the_floor", counts.heldAtTheFloor}};
}

}  // namespace

Json toJson(const proc::Prediction& prediction) {
    return {{"random", toJson(prediction.random)},
            {"systematic", toJson(prediction.systematic)},
            {"total", toJson(prediction.total)},
            {"cells", prediction.cells}};
}

Json promiseOf(const proc::Plan& plan) {
    Json promise{{"seconds", plan.seconds.total().count()},
                 {"wanted", plan.wanted},
                 {"frames", framesOf(plan)},
                 {"notes", plan.notes}};
    promise.update(toJson(plan.predicted));
    return promise;
}

Json toJson(const proc::Plan& plan) {
    Json pilots = Json::array(), darks = Json::array(), states = Json::array();
    for (const proc::ShotKind& pilot : plan.pilots) pilots.push_back(toJson(pilot));
    for (const proc::DarkCapture& dark : plan.darks) {
        darks.push_back({{"exposure_us", dark.exposure.count() * 1e6}, {"frames", dark.frames}});
    }
    for (const proc::StatePlan& state : plan.states) states.push_back(toJson(state));
    return {{"wanted", plan.wanted},
            {"seconds", toJson(plan.seconds)},
            {"cramer_rao_seconds", plan.cramerRao.count()},
            {"predicted", toJson(plan.predicted)},
            {"frames", framesOf(plan)},
            {"pilots", std::move(pilots)},
            {"darks", std::move(darks)},
            {"states", std::move(states)},
            {"cells", toJson(plan.counts)},
            {"proven", plan.proven},
            {"notes", plan.notes}};
}

}  // namespace gonio::daemon
