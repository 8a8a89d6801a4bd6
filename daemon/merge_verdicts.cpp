#include "daemon/merge_verdicts.h"

#include <algorithm>

#include "daemon/sample_quality.h"
#include "proc/quality/verdict.h"

namespace gonio::daemon {
namespace {

/// Refused before warned before good before what nobody knows.
int badness(proc::Grade grade) {
    switch (grade) {
        case proc::Grade::Refused: return 3;
        case proc::Grade::Warned: return 2;
        case proc::Grade::Ok: return 1;
        case proc::Grade::NotDetermined: break;
    }
    return 0;
}

void putWorse(std::vector<proc::Verdict>& all, proc::Verdict verdict) {
    const auto same = std::find_if(
        all.begin(), all.end(), [&](const proc::Verdict& one) { return one.name == verdict.name; });
    if (same == all.end()) {
        all.push_back(std::move(verdict));
    } else if (badness(verdict.grade) > badness(same->grade)) {
        *same = std::move(verdict);
    }
}

}  // namespace

void judge(Merged& merged,
           std::span<const MergeInput> inputs,
           std::span<const proc::Verdict> found,
           const proc::QualityLimits& limits) {
    std::vector<proc::Verdict> all;
    for (const MergeInput& input : inputs) {
        for (proc::Verdict& one : proc::readVerdicts(input.sample->info.qcVerdicts)) {
            if (inputs.size() > 1) one.evidence = input.file + ": " + one.evidence;
            putWorse(all, std::move(one));
        }
    }
    merged.sample.info.qcVerdicts = proc::verdictsText(all);
    judgeTable(merged.sample, limits);
    all = proc::readVerdicts(merged.sample.info.qcVerdicts);
    for (const proc::Verdict& one : found) {
        const auto first =
            std::find_if(found.begin(), found.end(), [&](const proc::Verdict& other) {
                return other.name == one.name;
            });
        if (&*first == &one) {
            proc::put(all, one);
        } else {
            putWorse(all, one);
        }
    }
    merged.sample.info.qcVerdicts = proc::verdictsText(all);
}

}  // namespace gonio::daemon
