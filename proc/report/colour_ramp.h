#pragma once
// A perceptually even ramp from dark blue over green to yellow: equal steps look equal, and it
// stays ordered in grey and for colour-blind eyes.

#include <string>

namespace gonio::proc {

/// "#rrggbb" at position t, clamped to [0, 1]; NaN as 0.
[[nodiscard]] std::string rampColour(double t);

/// A logarithmic axis of whole decades.
struct LogAxis {
    int firstDecade = -3;
    int lastDecade = 0;

    /// The fewest decades that hold [lowest, highest], at least one; of more than eight, the upper
    /// eight. Both positive and finite.
    [[nodiscard]] static LogAxis covering(double lowest, double highest);
    /// 0 at the first decade, 1 at the last, clamped; 0 and below lie at 0.
    [[nodiscard]] double position(double value) const;
};

}  // namespace gonio::proc
