#include "daemon/sample_pose.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/core/log.h"
#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/quality/tilt.h"
#include "proc/quality/tilt_correction.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::string degrees(Radians angle) { return fixed(angle.degrees(), 2) + " degrees"; }

/// "tilt: 0.52 degrees (u 0.01 degrees), corrected".
std::string described(const proc::TiltEstimate& estimate, bool corrected) {
    if (!estimate.determined) {
        return "tilt and waviness: not determined, as the lobe is none that can be fitted; " +
               degrees(estimate.joint.u) + " of tilt are in the uncertainties";
    }
    return "tilt: " + degrees(estimate.joint.tilt()) + " (u " + degrees(estimate.joint.u) + "), " +
           (corrected ? "corrected" : "not corrected") +
           "; waviness: " + degrees(estimate.waviness);
}

std::string objection(const proc::TiltEstimate& estimate, const PoseLimits& limits) {
    if (estimate.waviness > limits.wavy) {
        return "the sample is wavy: under the LEDs its normals differ by " +
               degrees(estimate.waviness) + " rms, at most " + degrees(limits.wavy) +
               " is good; flatten it";
    }
    if (estimate.joint.tilt() > limits.refused) {
        return "the sample is tilted by " + degrees(estimate.joint.tilt()) + ", at most " +
               degrees(limits.refused) + " is good; seat it again";
    }
    return {};
}

bool worthCorrecting(const proc::TiltEstimate& estimate, const PoseLimits& limits) {
    const Radians tilt = estimate.joint.tilt();
    return tilt > limits.corrected && tilt > estimate.joint.u * 3;
}

/// Median over the cells of what the tilt has added to u_systematic, relative.
double medianAdded(const proc::CellSamples& before, const proc::CellSamples& after) {
    std::vector<double> relative;
    for (std::size_t cell = 0; cell < after.size(); ++cell) {
        if (!after.present(cell) || !(after.f[cell] > 0)) continue;
        const double had = before.uSystematic[cell] / before.f[cell];
        const double has = after.uSystematic[cell] / after.f[cell];
        relative.push_back(std::sqrt(std::max(0.0, has * has - had * had)));
    }
    return relative.empty() ? 0 : median(std::move(relative));
}

/// The budget with a line for the tilt in each state.
std::string withTilt(const std::string& budgetJson,
                     const proc::SampleSet& before,
                     const proc::SampleSet& after) {
    Json budget = Json::parse(budgetJson, nullptr, false);
    if (!budget.is_array()) return budgetJson;
    for (std::size_t i = 0; i < budget.size(); ++i) {
        const std::size_t led = i / kBands.size(), band = i % kBands.size();
        if (led >= after.leds.size()) break;
        budget[i]["components"].push_back(
            {{"name", "tilt of the sample"},
             {"type", "A"},
             {"correlation", "common"},
             {"median_relative",
              medianAdded(before.leds[led].bands[band], after.leds[led].bands[band])}});
    }
    return budget.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Result<proc::SampleSet> referredToItsNormal(proc::SampleSet sample,
                                            Radians uAngle,
                                            bool force,
                                            const PoseLimits& limits) {
    const std::optional<proc::TiltEstimate> estimate = proc::estimateTilt(sample, uAngle);
    if (!estimate || estimate->lobes.front().alpha > limits.matt) {
        sample.info.qcVerdicts = "tilt: not determined, as there is no lobe that would suffer";
        return sample;
    }
    if (const std::string bad = objection(*estimate, limits); !bad.empty()) {
        if (!force) return Error{ErrorKind::Quality, bad + ", or measure with --force"};
        log::warning(bad + "; measured all the same");
    } else if (estimate->joint.tilt() > limits.warned) {
        log::warning("the sample is tilted by " + degrees(estimate->joint.tilt()));
    }
    if (!estimate->determined) log::warning(described(*estimate, false));
    const bool corrected = worthCorrecting(*estimate, limits);
    proc::SampleSet flat = corrected ? proc::tiltCorrected(sample, *estimate)
                                     : proc::withTiltUncertainty(sample, *estimate);
    flat.info.qcVerdicts = described(*estimate, corrected);
    flat.info.budgetJson = withTilt(sample.info.budgetJson, sample, flat);
    return flat;
}

}  // namespace gonio::daemon
