#pragma once
// `gonio merge`: what is asked is worked out from the files. Samples of several rotations become
// one sample of all of them; those of the same rotation are averaged first, with a report of what
// disagrees; three files of one band each become one of three bands. On request the sample is then
// averaged over its rotations, over the sides of the plane of incidence, and over reciprocal pairs;
// docs/merging.md has the equations.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "daemon/merge_inputs.h"
#include "proc/estimate/channels.h"
#include "proc/quality/limits.h"
#include "proc/table/average.h"

namespace gonio::daemon {

struct MergeOptions {
    bool plane = false;
    bool isotropic = false;
    bool reciprocal = false;
    bool anyCalibration = false;  ///< of other rigs or by other references, too
    proc::QualityLimits limits{};
};

/// How well what was averaged agreed.
struct MergeCheck {
    std::string name;                 ///< repeats, isotropy, plane, reciprocity
    std::optional<Radians> rotation;  ///< of repeats
    proc::Consistency cells;
    std::optional<proc::Consistency> light;  ///< of the states' common factors
};

/// A state's light, or an outlier, of one file.
struct FileState {
    std::string file;
    Radians rotation;
    proc::StateScale state;
};
struct FileOutlier {
    std::string file;
    Radians rotation;
    proc::Outlier outlier;
};

struct Merged {
    std::string how;  ///< "repeats", "rotations", "rotations of repeats", "channels", "one sample"
    proc::SampleSet sample;              ///< without LEDs where scattered values were merged
    std::vector<proc::ChannelRow> rows;  ///< these
    std::vector<MergeCheck> checks;
    std::vector<FileState> states;
    std::vector<FileOutlier> outliers;  ///< the furthest first
    std::optional<std::array<proc::ChannelCount, 3>> channels;
    std::vector<std::string> notes;
};

/// Usage error where the files contradict each other, or what is asked of them: it names the files
/// and, where there is one, the option that resolves it.
[[nodiscard]] Result<Merged> merged(const std::vector<MergeInput>& inputs,
                                    const MergeOptions& options);

/// The same of samples that hold the same bands; `judged`: the files whose verdicts count.
[[nodiscard]] Result<Merged> mergedAlike(const std::vector<MergeInput>& inputs,
                                         const MergeOptions& options,
                                         std::span<const MergeInput> judged);

}  // namespace gonio::daemon
