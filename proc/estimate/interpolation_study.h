#pragma once
// How wrong an estimator is between and beyond the angles that were measured, on surfaces whose
// truth is known: a sample is made up as the rig would measure it (cell means at 0, 20, 40 and 60
// degrees to theta_o 75, noise where wanted), estimators are made from it alone, and their answers
// are compared with the truth at cell centres elsewhere.

#include <optional>
#include <string>
#include <vector>

#include "proc/core/scatterer.h"
#include "proc/core/stopwatch.h"
#include "proc/estimate/study_materials.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

struct SyntheticOptions {
    std::vector<Radians> incidences{0_deg, 20_deg, 40_deg, 60_deg};
    int rows = 75;                ///< of cells, from the normal
    double relativeNoise = 0;     ///< standard deviation, per cell and band
    double leastRelative = 1e-3;  ///< of the stated u_random, beside a floor of 1e-6 / sr
    std::uint64_t seed = 1;
};

/// Means over the cells by 4 x 4 Gauss nodes; u_random as the noise, u_systematic 0.
[[nodiscard]] SampleSet syntheticSample(const Scatterer& truth,
                                        const SyntheticOptions& options = {});

/// Relative error of f, root mean square over directions weighted by solid angle; directions darker
/// than 1e-5 / sr, or of which the truth says nothing, do not count.
struct RegionError {
    double hemisphere = 0;  ///< all directions asked
    double lobe = 0;        ///< where the truth is above a tenth of its largest value there
    double within2u = 0;    ///< share of values within twice the answer's u; NaN where none has u
    double unanswered = 0;  ///< share of values
};

struct Asked {
    std::vector<Radians> incidences;
    int firstRow = 0;  ///< of theta_o, degrees
    int lastRow = 75;  ///< exclusive
    int stride = 1;    ///< every how many cells
};

/// The pairs at which an estimator is asked: every stride-th cell of the rows, at each incidence.
[[nodiscard]] std::vector<LightView> askedPairs(const Asked& asked);

/// Wall time of an answer in microseconds, on all cores, over these pairs. 0 for no pairs.
[[nodiscard]] double microsecondsPerAnswer(const Scatterer& estimator,
                                           const std::vector<LightView>& pairs,
                                           const Clock& clock);

/// All bands, all incidences together.
[[nodiscard]] RegionError errorOf(const Scatterer& estimator,
                                  const Scatterer& truth,
                                  const Asked& asked);

}  // namespace gonio::proc
