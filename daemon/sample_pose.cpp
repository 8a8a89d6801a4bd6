#include "daemon/sample_pose.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/quality/tilt_correction.h"
#include "proc/quality/verdict.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::string degrees(Radians angle) { return fixed(angle.degrees(), 2) + " degrees"; }

proc::Figure figure(Radians value, Radians u) {
    return {.value = value.degrees(), .u = u.degrees(), .unit = "degrees", .limit = 0};
}

proc::Verdict tiltVerdict(const proc::TiltEstimate& estimate,
                          bool corrected,
                          const PoseLimits& limits) {
    const Radians tilt = estimate.joint.tilt();
    proc::Verdict verdict{.name = "tilt",
                          .figure = figure(tilt, estimate.joint.u),
                          .evidence = "the sample is tilted by " + degrees(tilt),
                          .next = {}};
    verdict.grade =
        proc::graded(*verdict.figure, {limits.warned.degrees(), limits.refused.degrees()});
    if (verdict.grade == proc::Grade::Refused) {
        verdict.evidence += ", at most " + degrees(limits.refused) + " is good";
    } else {
        verdict.evidence += corrected ? ", corrected" : ", not corrected";
    }
    if (verdict.grade != proc::Grade::Ok) verdict.next = "seat it again";
    return verdict;
}

/// Standard uncertainty of the root mean square over the LEDs' normals.
Radians uOfWaviness(const proc::TiltEstimate& estimate) {
    double squares = 0, count = 0;
    for (const auto& led : estimate.leds) {
        if (!led) continue;
        squares += led->u.value() * led->u.value();
        ++count;
    }
    return Radians(count > 0 ? std::sqrt(squares) / count : 0);
}

proc::Verdict wavinessVerdict(const proc::TiltEstimate& estimate, const PoseLimits& limits) {
    proc::Verdict verdict{
        .name = "waviness",
        .figure = figure(estimate.waviness, uOfWaviness(estimate)),
        .evidence = "under the LEDs its normals differ by " + degrees(estimate.waviness) + " rms",
        .next = {}};
    const double limit = limits.wavy.degrees();
    verdict.grade = proc::graded(*verdict.figure, {limit, limit});
    if (verdict.grade == proc::Grade::Refused) {
        verdict.evidence = "the sample is wavy: " + verdict.evidence + ", at most " +
                           degrees(limits.wavy) + " is good";
        verdict.next = "flatten it";
    }
    return verdict;
}

proc::Verdict withoutLobe(const std::string& name) {
    return {
        .name = name, .figure = {}, .evidence = "there is no lobe that would suffer", .next = {}};
}

/// There is a lobe, and none that can be fitted.
proc::Verdict undetermined(const std::string& name, const proc::TiltEstimate& estimate) {
    return {.name = name,
            .figure = {},
            .evidence = "the lobe is none that can be fitted; " + degrees(estimate.joint.u) +
                        " of tilt are in the uncertainties",
            .next = "seat it well"};
}

/// Among those that the sample has already.
void putBoth(proc::SampleInfo& info, proc::Verdict tilt, proc::Verdict waviness) {
    std::vector<proc::Verdict> verdicts = proc::readVerdicts(info.qcVerdicts);
    proc::put(verdicts, std::move(tilt));
    proc::put(verdicts, std::move(waviness));
    info.qcVerdicts = proc::verdictsText(verdicts);
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

/// With a line for what its seat may do to it.
proc::SampleSet widened(const proc::SampleSet& sample, const proc::TiltEstimate& estimate) {
    proc::SampleSet wider = proc::withTiltUncertainty(sample, estimate);
    wider.info.budgetJson = withTilt(sample.info.budgetJson, sample, wider);
    return wider;
}

}  // namespace

bool worthCorrecting(const std::optional<proc::TiltEstimate>& estimate, const PoseLimits& limits) {
    if (!estimate || !estimate->determined) return false;
    if (estimate->lobes.front().alpha > limits.matt) return false;
    const Radians tilt = estimate->joint.tilt();
    return tilt > limits.corrected && tilt > estimate->joint.u * 3;
}

proc::SampleSet referredToItsNormal(proc::SampleSet sample,
                                    Radians uAngle,
                                    const PoseLimits& limits) {
    const std::optional<proc::TiltEstimate> estimate = proc::estimateTilt(sample, uAngle);
    return referredToItsNormal(std::move(sample), estimate, limits);
}

proc::SampleSet referredToItsNormal(proc::SampleSet sample,
                                    const std::optional<proc::TiltEstimate>& estimate,
                                    const PoseLimits& limits) {
    if (!estimate || estimate->lobes.front().alpha > limits.matt) {
        putBoth(sample.info, withoutLobe("tilt"), withoutLobe("waviness"));
        return widened(sample, proc::seated(sample.leds.size()));
    }
    if (!estimate->determined) {
        putBoth(sample.info, undetermined("tilt", *estimate), undetermined("waviness", *estimate));
        return widened(sample, *estimate);
    }
    const bool corrected = worthCorrecting(estimate, limits);
    proc::SampleSet flat = corrected ? proc::tiltCorrected(sample, *estimate)
                                     : proc::withTiltUncertainty(sample, *estimate);
    putBoth(
        flat.info, tiltVerdict(*estimate, corrected, limits), wavinessVerdict(*estimate, limits));
    flat.info.budgetJson = withTilt(sample.info.budgetJson, sample, flat);
    return flat;
}

}  // namespace gonio::daemon
