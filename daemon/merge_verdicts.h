#pragma once
// The verdicts of a merged sample: of each kind the worst that any of its files has, with the
// file's name, and those that its table is judged by anew.

#include <span>

#include "daemon/merging.h"
#include "proc/quality/verdict.h"

namespace gonio::daemon {

/// `found`: verdicts on what was averaged, of before: afterwards all agree. The first of a name
/// counts where it is worse.
void judge(Merged& merged,
           std::span<const MergeInput> inputs,
           std::span<const proc::Verdict> found,
           const proc::QualityLimits& limits);

}  // namespace gonio::daemon
