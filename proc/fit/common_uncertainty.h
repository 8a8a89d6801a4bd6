#pragma once
// The systematic uncertainty that what is made of all values of a band shares with them.

#include "proc/fit/brdf_data.h"

namespace gonio::proc {

/// Relative to f: the median over the band's positive values of what is common to them all. 0 where
/// nothing is known.
[[nodiscard]] double commonRelative(const BrdfData& data, std::size_t band);
/// Likewise, and of what an LED or a patch of directions shares: for what does not weigh that by
/// itself (a fit's covariance does).
[[nodiscard]] double sharedRelative(const BrdfData& data, std::size_t band);

}  // namespace gonio::proc
