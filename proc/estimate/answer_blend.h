#pragma once
// An answer made of others by weights: f is their weighted sum, u_random adds in quadrature (the
// values are taken as independent), u_systematic with its sign (as common to them all), each known
// only where it is known of all. What the method itself is wrong by is in neither.
//
// Flags are those of all parts together, but for where a value came from: of these (measured,
// interpolated, extrapolated) the answer has the one that it is given.

#include <cstddef>

#include "proc/core/scatterer.h"
#include "proc/table/scattered_set.h"

namespace gonio::proc {

/// What a sample answers at its own pair.
[[nodiscard]] Answer answerOf(const ScatteredSample& sample);

class AnswerBlend {
public:
    /// A part of weight 0 is left out, and its NaN and flags with it.
    void add(double weight, const Answer& part);
    /// A weight for each band; of weight 0 a NaN still counts.
    void add(const LedBands& weight, const Answer& part);

    /// The weighted sum; no answer where no band has a number.
    [[nodiscard]] Answer sum(Source source) const;
    /// The sum over the weights: no answer of no parts.
    [[nodiscard]] Answer mean(Source source) const;
    /// Made of a single part, and that a measured one.
    [[nodiscard]] bool isOneMeasurement() const { return parts_ == 1 && allMeasured_; }

private:
    [[nodiscard]] Answer scaled(const LedBands& by, Source source) const;

    LedBands weight_;
    LedBands f_;
    LedBands randomSquared_;
    LedBands systematic_;
    bool knowsRandom_ = true;
    bool knowsSystematic_ = true;
    Flags flags_;
    std::size_t parts_ = 0;
    bool allMeasured_ = true;
};

}  // namespace gonio::proc
