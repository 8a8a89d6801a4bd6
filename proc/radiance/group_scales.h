#pragma once
// The effective times of a bracket, from its own pictures. A group's nominal tau = t L / 65535 is
// off by what the sensor exposes longer than it grants (0.2 us of 20 us are 1 %) and by how far the
// light of an LED is from proportional to its level. Pixels that are exposed well in two groups
// tell their ratio; scale_system.h fits all of them at once, each nominal tau with an uncertainty
// of its own. So it is mostly the shortest and the dimmed groups that move, and one that shares no
// pixel with the others keeps its nominal tau and its uncertainty.
//
// A common factor of all groups cannot be seen; it stays within what the nominal times allow.

#include <cstddef>
#include <vector>

#include "proc/core/units.h"
#include "proc/radiance/merge.h"
#include "proc/radiance/merge_accumulator.h"
#include "proc/radiance/scale_system.h"

namespace gonio::proc {

/// How well frames are known beforehand (k = 1): tau, and for the comparison of frames their zero.
struct NominalUncertainty {
    Seconds exposure{0.5e-6};  ///< of each exposure
    double relative = 1e-4;    ///< of any tau
    double dimmed = 0.02;      ///< of a level below full
    /// Of the mean of a frame less its dark frame, in units of a pixel's noise without light: the
    /// sensor's zero wanders, and its columns are off by some tenths of an electron each.
    /// In a frame of next to no light nothing else is to be seen.
    double zero = 0.05;

    /// Of a group's tau, relative.
    [[nodiscard]] double of(const GroupSums& group) const;
};

struct GroupScale {
    Nanoseconds granted{0};
    std::uint16_t level = 0;
    double uNominal = 0;      ///< relative
    BrightnessOffset offset;  ///< of tau against nominal
};

/// By how much `to` is brighter than the nominal tau of the two say it should be against `from`,
/// from their common pixels alone.
struct RatioResidual {
    std::size_t from = 0, to = 0;  ///< groups
    BrightnessOffset offset;
};

struct ScaleReport {
    std::vector<GroupScale> groups;     ///< as in the sums
    std::vector<RatioResidual> ratios;  ///< of neighbours by tau that have pixels in common
};

/// `state` is the merge of the sums.
[[nodiscard]] ScaleReport groupScales(const BracketSums& sums,
                                      const MergedState& state,
                                      const NominalUncertainty& nominal = {});

/// Puts the effective times right by the offsets that were found; merge again after it. What is
/// left of each group is the uncertainty in the report, common to all pixels.
void correctScales(MergeAccumulator& accumulator, const ScaleReport& report);

}  // namespace gonio::proc
