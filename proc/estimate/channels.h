#pragma once
// Three surfaces of one band each as one of three bands. Each value of a band looks for its partner
// in the others: the same cell of the same LED and rotation, or, of scattered values, the nearest
// pair within a tenth of a degree. Where a band has none there, its value is estimated, in that
// band without the flag `measured` and with `interpolated`:
//
//   cells      the mean of the measured ones of that band among the up to eight around it, three at
//              least, with their mean u_systematic and, as u_random, the larger of their mean u and
//              half of what they span
//   scattered  Shepard's mean of the four nearest within three degrees (shepard.h)
//
// Where there is nothing near, the band is missing. Negative values are values.

#include <array>
#include <optional>
#include <vector>

#include "proc/core/result.h"
#include "proc/table/sample_set.h"
#include "proc/table/scattered_set.h"

namespace gonio::proc {

/// What became of a band's values.
struct ChannelCount {
    std::size_t partners = 0;   ///< as they were measured; once for each row that they are in
    std::size_t estimated = 0;  ///< where another band has a value
    std::size_t missing = 0;
};

struct MergedSample {
    SampleSet set;  ///< without information
    std::array<ChannelCount, 3> counts;
};
/// R, G, B, each with its own band alone. LEDs are matched by incidence, to half a degree, and
/// rotation; one that not all have keeps the bands that it has.
[[nodiscard]] MergedSample mergedChannels(const std::array<const SampleSet*, 3>& bands);

/// One pair of directions; a band that is missing has f = u = NaN.
struct ChannelRow {
    LightView pair;
    std::array<double, 3> f{}, u{};  ///< u: combined, NaN where it is not known
    std::array<Flags, 3> flags{};
};
struct MergedScattered {
    /// R's pairs, then of G and B what is nobody's partner: each value stands in a row.
    std::vector<ChannelRow> rows;
    std::array<ChannelCount, 3> counts;
};
/// R, G, B, each of BandCount::One. A Usage error where their symmetries differ.
[[nodiscard]] Result<MergedScattered> mergedChannels(
    const std::array<const ScatteredSet*, 3>& bands);

}  // namespace gonio::proc
