#pragma once
// The verdicts of a merged sample: of each kind the worst that any of its files has, with the
// file's name, and those that its table is judged by anew.

#include <span>

#include "daemon/merging.h"

namespace gonio::daemon {

/// `repeats`: the averages of each rotation that was measured more than once.
void judge(Merged& merged,
           std::span<const MergeInput> inputs,
           std::span<const proc::Averaged> repeats,
           const proc::QualityLimits& limits);

}  // namespace gonio::daemon
