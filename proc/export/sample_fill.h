#pragma once
// A measured sample's cells made by asking a Scatterer at their centres: the way from anything that
// answers to `.gonio` and to formats that list directions. A cell without an answer is missing; one
// whose uncertainty is not known has NaN there.

#include <cstddef>
#include <span>
#include <vector>

#include "proc/core/scatterer.h"
#include "proc/table/metadata.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

struct SampleGrid {
    std::vector<double> incidenceDeg;    ///< ascending
    std::vector<double> rotationDeg{0};  ///< of the sample under the light, ascending
    std::vector<Band> bands{kBands.begin(), kBands.end()};
};

struct FilledSample {
    SampleSet set;
    std::size_t asked = 0;         ///< values: cells times bands
    std::size_t unanswered = 0;    ///< missing in the sample
    std::size_t extrapolated = 0;  ///< answered from beyond what was measured
};

[[nodiscard]] FilledSample fillSample(const Scatterer& from,
                                      const SampleGrid& grid,
                                      const Metadata& about);

}  // namespace gonio::proc
