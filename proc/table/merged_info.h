#pragma once
// What a merged sample says of itself: what is the same in all parts, and the rest as a list;
// seconds and interruptions add up; and the uncertainty budget, which names its states by the
// number of their LED and has to follow where the tables went.

#include <span>
#include <string>

#include "proc/table/sample_set.h"

namespace gonio::proc {

/// `how`: "rotations", "repeats", ...; kept as extra "merged" with the parts' names and dates.
/// Texts that differ are joined with "; " (calibrations, sessions, certificates, notes); the truth
/// of a simulated sample is kept where it is the same. Verdicts are left to the caller.
[[nodiscard]] SampleInfo mergedInfo(std::span<const SampleInfo> parts, const std::string& how);

/// A text of mergedInfo that was joined of several that differ.
[[nodiscard]] bool ofSeveral(const std::string& text);

/// The budgets of sets whose tables follow one another: the states of the second come after the
/// tables of the first. Empty where no set has one that can be read.
[[nodiscard]] std::string joinedBudget(std::span<const SampleSet> sets);

/// The set's tables of one rotation, with the budget that is theirs.
[[nodiscard]] SampleSet tablesAt(const SampleSet& set, Radians rotation);

/// Of a set whose tables were put together from sets of one band each: the states of each, where
/// their tables (by incidence and rotation) went.
[[nodiscard]] std::string budgetOfChannels(const SampleSet& merged,
                                           std::span<const SampleSet> bands);

/// Of `average`, whose tables are the means of the captures' of the same incidence: each size is
/// the mean over the captures that have the component in that state, and what is per cell and of
/// type A is multiplied by `random`, the factor by which u_random fell.
[[nodiscard]] std::string averagedBudget(const SampleSet& average,
                                         std::span<const SampleSet> captures,
                                         double random);

}  // namespace gonio::proc
