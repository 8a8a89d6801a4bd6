#pragma once
// Formats that list one value per entry, each with its four angles and its channel, beside rows
// that have all channels of a pair together: which entries are of one pair.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gonio::proc {

/// Columns of one length; the angles in any unit, as they stand.
struct EntryColumns {
    std::span<const double> thetaIn, phiIn, thetaOut, phiOut;
    std::span<const std::uint32_t> channel;
    std::size_t channels = 1;
};

struct EntryPairs {
    std::vector<std::uint32_t> pairOf;   ///< of each entry
    std::vector<std::uint32_t> firstOf;  ///< the first entry of each pair, in the file's order
};

/// Entries of equal angles are one pair, as far as their channels differ: a channel that comes
/// again begins a new pair. The order is tried first that needs no search: channels fastest (the
/// entries of a pair follow one another), then slowest (the same pairs for each channel).
[[nodiscard]] EntryPairs pairEntries(const EntryColumns& columns);

}  // namespace gonio::proc
