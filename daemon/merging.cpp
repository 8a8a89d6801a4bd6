#include "daemon/merging.h"

#include <algorithm>
#include <cmath>

#include "daemon/channel_merging.h"
#include "daemon/merge_checks.h"
#include "daemon/merge_verdicts.h"
#include "proc/quality/reciprocity.h"
#include "proc/quality/symmetry.h"
#include "proc/table/achieved.h"
#include "proc/table/merged_info.h"
#include "proc/table/plane_symmetry.h"
#include "proc/table/reciprocal_average.h"
#include "proc/table/rotations.h"

namespace gonio::daemon {
namespace {

/// One rotation of one file.
struct Capture {
    const MergeInput* input = nullptr;
    proc::SampleSet set;
};

/// Of one rotation, in the order of the files.
struct Turn {
    Radians rotation;
    std::vector<Capture> captures;
};

std::vector<Turn> turnsOf(const std::vector<MergeInput>& inputs) {
    std::vector<Turn> turns;
    for (const MergeInput& input : inputs) {
        for (const Radians rotation : proc::rotationsOf(*input.sample)) {
            auto turn = std::find_if(turns.begin(), turns.end(), [&](const Turn& one) {
                return proc::sameRotation(one.rotation, rotation);
            });
            if (turn == turns.end()) turn = turns.insert(turns.end(), {rotation, {}});
            turn->captures.push_back({&input, proc::tablesAt(*input.sample, rotation)});
            proc::turnTo(turn->captures.back().set, turn->rotation);
        }
    }
    std::sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) {
        return a.rotation < b.rotation;
    });
    return turns;
}

class SampleMerge {
public:
    SampleMerge(const std::vector<MergeInput>& inputs,
                const MergeOptions& options,
                std::span<const MergeInput> judged)
        : inputs_(inputs), options_(options), judged_(judged), averages_(averagesOf(inputs)) {}

    Result<Merged> run() {
        if (Result<void> good = checkBands(inputs_); !good) return good.error();
        if (Result<void> good = checkOrigins(inputs_, options_); !good) return good.error();
        if (Result<void> good = checkAverages(inputs_, options_); !good) return good.error();
        std::vector<Turn> turns = turnsOf(inputs_);
        if (Result<void> good = checkAsked(turns); !good) return good.error();
        noteCalibrations();
        std::vector<proc::SampleSet> parts;
        parts.reserve(turns.size());
        for (Turn& turn : turns) parts.push_back(averaged(turn));
        merged_.how = howOf(turns);
        join(parts);
        judgeBefore();
        if (options_.isotropic) overRotations(parts);
        if (options_.plane) overPlane();
        if (options_.reciprocal) overReciprocals();
        if (!averages_.empty()) merged_.sample.info.extra["averaged"] = averages_;
        merged_.sample.info.achievedUncertainty = proc::achievedUncertainty(merged_.sample);
        judge(merged_, judged_, found_, options_.limits);
        std::stable_sort(merged_.outliers.begin(),
                         merged_.outliers.end(),
                         [](const FileOutlier& a, const FileOutlier& b) {
                             return std::abs(a.outlier.away) > std::abs(b.outlier.away);
                         });
        return std::move(merged_);
    }

private:
    Result<void> checkAsked(const std::vector<Turn>& turns) const {
        const bool asked = options_.plane || options_.isotropic || options_.reciprocal;
        if (inputs_.size() == 1 && !asked) {
            return mergeError(quoted(inputs_.front()) +
                              ": one sample is nothing to merge; name another, or ask for --plane, "
                              "--isotropic or --reciprocal");
        }
        if (options_.isotropic && turns.size() == 1) {
            return mergeError("--isotropic: all are of rotation " +
                              degrees(turns.front().rotation) +
                              " degrees; measure others with --rotation");
        }
        return {};
    }

    void noteCalibrations() {
        std::vector<std::string> ids;
        for (const MergeInput& input : inputs_) {
            const std::string& id = input.sample->info.calibrationId;
            if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
            if (input.sample->info.budgetJson.empty())
                merged_.notes.push_back(quoted(input) +
                                        " has no uncertainty budget: all of its u_systematic is "
                                        "taken as its own, and chi-square is too small");
        }
        if (ids.size() < 2) return;
        merged_.notes.push_back("measured by " + std::to_string(ids.size()) +
                                " calibrations: the light of each counts as its own; what is "
                                "systematic is taken as common to them");
    }

    std::string howOf(const std::vector<Turn>& turns) const {
        const bool repeats = std::any_of(
            turns.begin(), turns.end(), [](const Turn& turn) { return turn.captures.size() > 1; });
        if (inputs_.size() == 1) return "one sample";
        if (turns.size() == 1) return "repeats";
        return repeats ? "rotations of repeats" : "rotations";
    }

    void report(const proc::Averaged& result,
                Radians rotation,
                const std::vector<std::string>& files) {
        for (const proc::StateScale& state : result.states)
            merged_.states.push_back({files[state.capture], rotation, state});
        for (const proc::Outlier& one : result.outliers)
            merged_.outliers.push_back({files[one.capture], rotation, one});
    }

    /// The repeats of one rotation.
    proc::SampleSet averaged(Turn& turn) {
        if (turn.captures.size() == 1) return std::move(turn.captures.front().set);
        std::vector<proc::SampleSet> sets;
        std::vector<std::string> files;
        for (Capture& one : turn.captures) {
            sets.push_back(std::move(one.set));
            files.push_back(one.input->file);
        }
        proc::Averaged result = proc::averageOf(sets);
        result.set.info.budgetJson =
            proc::averagedBudget(result.set, sets, std::sqrt(result.weightSquares));
        merged_.checks.push_back({"repeats", turn.rotation, result.cells, result.scales});
        report(result, turn.rotation, files);
        found_.push_back(proc::repeatsVerdict(result, options_.limits));
        return std::move(result.set);
    }

    void join(const std::vector<proc::SampleSet>& parts) {
        std::vector<proc::SampleInfo> infos;
        infos.reserve(inputs_.size());
        for (const MergeInput& input : inputs_) infos.push_back(input.sample->info);
        proc::SampleSet& set = merged_.sample;
        set.info = inputs_.size() == 1 ? infos.front() : proc::mergedInfo(infos, merged_.how);
        set.info.budgetJson = proc::joinedBudget(parts);
        for (const proc::SampleSet& part : parts) {
            set.leds.insert(set.leds.end(), part.leds.begin(), part.leds.end());
        }
    }

    void overRotations(const std::vector<proc::SampleSet>& parts) {
        proc::Averaged result = proc::averageOf(parts);
        std::vector<std::string> files;
        files.reserve(parts.size());
        for (const proc::SampleSet& part : parts)
            files.push_back("rotation " + degrees(part.leds.front().rotation));
        merged_.checks.push_back({"isotropy", {}, result.cells, result.scales});
        found_.push_back(proc::isotropyVerdict(result, options_.limits));
        report(result, Radians(), files);
        merged_.sample.leds = std::move(result.set.leds);
        proc::turnTo(merged_.sample, Radians());
        merged_.sample.info.budgetJson =
            proc::averagedBudget(merged_.sample, parts, std::sqrt(result.weightSquares));
        note("isotropic");
    }

    /// By each rotation: a mean of rotations that contradict each other has an uncertainty that
    /// hides how its sides differ.
    void judgeBefore() {
        if (options_.plane) found_.push_back(proc::planeVerdict(merged_.sample, options_.limits));
        if (options_.reciprocal)
            found_.push_back(proc::reciprocityVerdict(merged_.sample, options_.limits));
    }

    void overPlane() {
        proc::Symmetrical result = proc::planeSymmetrical(std::move(merged_.sample));
        merged_.sample = std::move(result.set);
        merged_.checks.push_back({"plane", {}, result.consistency, {}});
        note("plane");
    }

    void overReciprocals() {
        proc::Reciprocal result = proc::reciprocalAverage(std::move(merged_.sample));
        merged_.sample = std::move(result.set);
        merged_.checks.push_back({"reciprocity", {}, result.consistency, {}});
        if (result.pairs == 0) {
            merged_.notes.emplace_back("--reciprocal: no two LEDs saw each other's direction");
        }
        note("reciprocal");
    }

    void note(const std::string& average) { averages_ += (averages_.empty() ? "" : ",") + average; }

    const std::vector<MergeInput>& inputs_;
    const MergeOptions& options_;
    std::span<const MergeInput> judged_;
    std::string averages_;
    std::vector<proc::Verdict> found_;  ///< on what was averaged
    Merged merged_;
};

}  // namespace

Result<Merged> mergedAlike(const std::vector<MergeInput>& inputs,
                           const MergeOptions& options,
                           std::span<const MergeInput> judged) {
    return SampleMerge(inputs, options, judged).run();
}

Result<Merged> merged(const std::vector<MergeInput>& inputs, const MergeOptions& options) {
    const bool scattered = std::any_of(inputs.begin(), inputs.end(), [](const MergeInput& one) {
        return !one.sample.has_value();
    });
    const bool oneBand = std::all_of(
        inputs.begin(), inputs.end(), [](const MergeInput& one) { return one.band.has_value(); });
    const bool sameBand = std::all_of(inputs.begin(), inputs.end(), [&](const MergeInput& one) {
        return one.band == inputs.front().band;
    });
    if (scattered || (oneBand && !sameBand)) return mergedBands(inputs, options);
    return mergedAlike(inputs, options, inputs);
}

}  // namespace gonio::daemon
