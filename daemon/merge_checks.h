#pragma once
// What keeps measured files from being merged: they contradict each other, or what is asked of
// them was done before. Each error names the files and what resolves it.

#include <span>
#include <string>

#include "daemon/merging.h"

namespace gonio::daemon {

/// Of kind Usage.
[[nodiscard]] Error mergeError(const std::string& what);

[[nodiscard]] std::string quoted(const MergeInput& input);
/// As files have it.
[[nodiscard]] std::string degrees(Radians angle);

/// All of these are of samples. Usage error unless all hold the same bands.
[[nodiscard]] Result<void> checkBands(std::span<const MergeInput> inputs);

/// Usage error unless they may be measurements of one piece by one rig and one set of references.
[[nodiscard]] Result<void> checkOrigins(std::span<const MergeInput> inputs,
                                        const MergeOptions& options);

/// Usage error where one was averaged already over what is asked for: its values are no longer
/// independent, and u would fall once more for nothing.
[[nodiscard]] Result<void> checkAverages(std::span<const MergeInput> inputs,
                                         const MergeOptions& options);

/// What any of the samples was averaged over, each once: "isotropic,plane".
[[nodiscard]] std::string averagesOf(std::span<const MergeInput> inputs);

}  // namespace gonio::daemon
