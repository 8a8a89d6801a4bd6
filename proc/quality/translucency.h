#pragma once
// The same sample on a black and on a white backing: what comes back from the backing through the
// sample is the difference,
//     pi (mean of f on white - mean of f on black),
// as a diffuse reflectance, by band. The mean is over the cells that both measured within 60
// degrees and at least 30 degrees from the mirror direction, where the sample's own lobe, and how
// it was seated, matter least. u_random averages; u_systematic is taken as one error of all cells,
// another one in each measurement, which is too much where both share a calibration.
//
// Light goes deeper the longer its wave: red is expected to be the largest.

#include <optional>
#include <string_view>

#include "proc/core/bands.h"
#include "proc/core/result.h"
#include "proc/quality/limits.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

enum class Backing {
    Black,
    White
};
[[nodiscard]] std::string_view name(Backing backing);
/// "black" or "white"; anything else is a Usage error.
[[nodiscard]] Result<Backing> parseBacking(std::string_view text);

struct BackingPair {
    const SampleSet& black;
    const SampleSet& white;
};
struct BackingDifference {
    LedBands reflectance;  ///< white minus black
    LedBands u;
};
/// Empty where the two have no LED, at one rotation, and no cell in common.
[[nodiscard]] std::optional<BackingDifference> backingDifference(const BackingPair& pair);

/// `translucency` of a sample that was measured on `backing`, if that is known: warned of on black,
/// refused on white when any band differs by three standard uncertainties and 0.5 % of reflectance.
/// Without a difference it is not determined.
[[nodiscard]] Verdict translucencyVerdict(const std::optional<BackingDifference>& difference,
                                          const std::optional<Backing>& backing,
                                          const QualityLimits& limits = {});

}  // namespace gonio::proc
