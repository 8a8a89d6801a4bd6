#include "daemon/sample_quality.h"

#include <algorithm>

#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_degrees.h"
#include "proc/quality/ambient.h"
#include "proc/quality/energy.h"
#include "proc/quality/reciprocity.h"
#include "proc/quality/repeat.h"
#include "proc/quality/saturation.h"
#include "proc/quality/symmetry.h"
#include "proc/quality/verdict.h"
#include "proc/table/rotations.h"

namespace gonio::daemon {
namespace {

constexpr const char* kBacking = "backing";

void put(proc::SampleSet& sample, std::vector<proc::Verdict> news) {
    std::vector<proc::Verdict> all = proc::readVerdicts(sample.info.qcVerdicts);
    for (proc::Verdict& verdict : news) proc::put(all, std::move(verdict));
    sample.info.qcVerdicts = proc::verdictsText(all);
}

std::string joined(const std::string& list, const std::string& one) {
    if (one.empty()) return list;
    return list.empty() ? one : list + "; " + one;
}

/// Of the state in which a unit of f shows least light.
std::optional<double> dimmestFieldSignal(const proc::SampleSet& sample,
                                         const RigReferences& references) {
    const PlacementSignals& white = references.white.signals;
    const PlacementSignals& black = references.black.signals;
    std::optional<double> dimmest;
    for (std::size_t led = 0; led < std::min({sample.leds.size(), white.size(), black.size()});
         ++led) {
        for (const Band band : kBands) {
            const std::size_t b = index(band);
            const auto signal =
                proc::fieldSignal({white[led][b],
                                   black[led][b],
                                   *references.certified.white,
                                   *references.certified.black},
                                  Direction::fromSpherical(sample.leds[led].incidence, Radians(0)),
                                  band);
            if (signal && (!dimmest || *signal < *dimmest)) dimmest = signal;
        }
    }
    return dimmest;
}

proc::Verdict ambientOf(const proc::SampleSet& sample,
                        const Captured& captured,
                        const RigReferences& references) {
    const proc::DarkFrame* dark = captured.freshDarks.longest();
    const proc::QualityLimits& limits = references.profile.quality.sample;
    if (dark == nullptr) return proc::ambientVerdict({}, {}, limits);
    return proc::ambientVerdict(
        proc::ambientLight(*dark, references.lens.fit.map, kField, references.profile.noise),
        dimmestFieldSignal(sample, references),
        limits);
}

std::optional<proc::RepeatChange> repeatChange(const proc::SampleSet& sample,
                                               const std::optional<Repeat>& repeat) {
    if (!repeat) return std::nullopt;
    const auto led = static_cast<std::size_t>(repeat->state.led);
    if (led >= sample.leds.size()) return std::nullopt;
    const Direction mirror = Direction::fromSpherical(sample.leds[led].incidence, Radians(kPi));
    return proc::changeBetween(repeat->first, repeat->last, mirror);
}

std::optional<proc::Backing> backingOf(const proc::SampleSet& sample) {
    const auto said = sample.info.extra.find(kBacking);
    if (said == sample.info.extra.end()) return std::nullopt;
    const auto backing = proc::parseBacking(said->second);
    return backing ? std::optional(*backing) : std::nullopt;
}

std::optional<proc::BackingDifference> differenceTo(const proc::SampleSet& sample,
                                                    const BackingEvidence& evidence) {
    if (!evidence.other || !evidence.backing) return std::nullopt;
    if (*evidence.backing == proc::Backing::Black) {
        return proc::backingDifference({.black = sample, .white = *evidence.other});
    }
    return proc::backingDifference({.black = *evidence.other, .white = sample});
}

}  // namespace

void noteLimits(const JudgingLimits& limits, proc::SampleInfo& info) {
    info.extra["quality_limits"] = limits.name;
}

void judgeTable(proc::SampleSet& sample, const proc::QualityLimits& limits) {
    put(sample,
        {proc::reciprocityVerdict(sample, limits),
         proc::planeVerdict(sample, limits),
         proc::isotropyVerdict(sample, limits),
         proc::energyVerdict(sample, limits),
         proc::saturationVerdict(sample, limits)});
}

void judgeCapture(proc::SampleSet& sample,
                  const Captured& captured,
                  const RigReferences& references) {
    const JudgingLimits& limits = references.profile.quality;
    const auto change = repeatChange(sample, captured.repeat);
    put(sample,
        {framesVerdict(captured.oddFrames),
         lightVerdict(captured.lightSteps, limits.lightStep),
         ambientOf(sample, captured, references),
         proc::softnessVerdict(change, limits.sample),
         proc::driftVerdict(change, limits.sample)});
}

Result<void> checkOther(const BackingEvidence& evidence) {
    if (!evidence.other) return {};
    const std::string& name = evidence.other->info.name;
    const auto theirs = backingOf(*evidence.other);
    if (!theirs) {
        return Error{ErrorKind::Usage,
                     "sample '" + name +
                         "' does not say on which backing it lay; measure it with --backing"};
    }
    if (!evidence.backing || *theirs == *evidence.backing) {
        return Error{ErrorKind::Usage,
                     "sample '" + name + "' lay on a " + std::string(proc::name(*theirs)) +
                         " backing; to hold one against it wants the other, with --backing"};
    }
    const std::vector<Radians> rotations = proc::rotationsOf(*evidence.other);
    const bool alike = std::any_of(rotations.begin(), rotations.end(), [&](Radians one) {
        return proc::sameRotation(one, evidence.rotation);
    });
    if (!alike) {
        const auto degrees = [](Radians angle) { return shortest(proc::fileDegrees(angle)); };
        const std::string at = rotations.empty() ? "" : degrees(rotations.front());
        return Error{ErrorKind::Usage,
                     rotations.empty()
                         ? "sample '" + name + "' has no LED; measure it anew with --backing"
                         : "sample '" + name + "' was measured at rotation " + at +
                               " degrees, not " + degrees(evidence.rotation) +
                               "; to hold one against it, measure with --rotation " + at};
    }
    return {};
}

void judgeBacking(proc::SampleSet& sample,
                  const BackingEvidence& evidence,
                  const proc::QualityLimits& limits) {
    if (evidence.backing) sample.info.extra[kBacking] = proc::name(*evidence.backing);
    put(sample,
        {proc::translucencyVerdict(differenceTo(sample, evidence), evidence.backing, limits)});
}

Result<void> accepted(const proc::SampleSet& sample, bool force) {
    std::string refused, next;
    for (const proc::Verdict& verdict : proc::readVerdicts(sample.info.qcVerdicts)) {
        if (verdict.grade == proc::Grade::Warned) {
            log::warning(joined(verdict.evidence, verdict.next));
        }
        if (verdict.grade != proc::Grade::Refused) continue;
        if (force) log::warning(verdict.evidence + "; measured all the same");
        refused = joined(refused, verdict.evidence);
        if (next.find(verdict.next) == std::string::npos) next = joined(next, verdict.next);
    }
    if (force || refused.empty()) return {};
    return Error{ErrorKind::Quality, joined(refused, next) + ", or measure with --force"};
}

}  // namespace gonio::daemon
