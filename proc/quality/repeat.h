#pragma once
// The first bracket of a capture against the same one repeated last. A soft sample is pressed when
// it is placed and relaxes: its lobe changes, and nothing far from it. An LED that drifts changes
// all cells alike. With S the sum of the signals over some cells, R = S(first) / S(last):
//     drift     R over cells more than 30 degrees from the mirror direction, minus 1;
//     softness  R over those within 10 degrees, over the former, minus 1.
// Only cells that are present in both count. Where a cell of the lobe is saturated its neighbours
// are cut as well, differently each time: nothing is said of softness there.

#include <optional>

#include "proc/core/direction.h"
#include "proc/optics/binning.h"
#include "proc/quality/limits.h"

namespace gonio::proc {

/// A relative change from first to last, positive where the first was brighter.
struct Change {
    double size = 0;
    double u = 0;
};
struct RepeatChange {
    std::optional<Change> drift;
    std::optional<Change> softness;
};
/// Both over CellGrid; `mirror` is where a mirror would send the light. A change is empty where its
/// cells show no light.
[[nodiscard]] RepeatChange changeBetween(const CellSignal& first,
                                         const CellSignal& last,
                                         const Direction& mirror);

/// Refused when beyond five standard uncertainties and the limit.
[[nodiscard]] Verdict softnessVerdict(const std::optional<RepeatChange>& change,
                                      const QualityLimits& limits = {});
/// Warned when beyond five standard uncertainties and the limit.
[[nodiscard]] Verdict driftVerdict(const std::optional<RepeatChange>& change,
                                   const QualityLimits& limits = {});

}  // namespace gonio::proc
