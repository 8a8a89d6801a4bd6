#pragma once
// A method asked both ways: at (wi, wo) and, as f is the same with light and view exchanged, at
// (wo, wi). What was measured at 20 and 40 degrees then answers exactly wherever theta_o is one of
// these, and beyond the last incidence wherever theta_o lies within. The two are weighted by how
// far each reaches beyond what was measured:
//   w = 1 / (between^2 + (degrees beyond the incidences / 5)^2 + (steps / 3)^2 + 1e-6),
// so that at an incidence that was measured its own values stand to 1e-6. A method that is not
// anchored is reciprocal by itself and is asked once.
//
// Where light and view may not be exchanged (BrdfData::exchanges), a pair is asked as it is alone.
//
// Near a pair that is its own exchange (the mirror direction, retroreflection) both ways are made
// of the same cells: their random errors are taken as common where the ways are one, as independent
// where they are a degree apart.

#include <array>

#include "proc/estimate/coverage.h"
#include "proc/estimate/incidence_method.h"

namespace gonio::proc {

/// Beyond what was measured, in units of 5 degrees of incidence and of 3 layers of cells.
[[nodiscard]] double beyond(const Reach& reach);

/// How an answer in one band came about.
struct BandWay {
    Reach reach;           ///< of the two ways, as they are weighted
    double exchanged = 0;  ///< weight of the exchanged pair, 0..1
    double off = 0;        ///< how far the nearer way is beyond what was measured; see beyond()
};

struct ReciprocalAnswer {
    MethodAnswer value;
    std::array<BandWay, 3> ways;  ///< by band
};

/// Any pair above the horizon.
[[nodiscard]] ReciprocalAnswer reciprocalAnswer(const IncidenceMethod& method,
                                                const Coverage& coverage,
                                                const LightView& pair);

}  // namespace gonio::proc
