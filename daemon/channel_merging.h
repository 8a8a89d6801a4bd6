#pragma once
// Three files of one band each as one of three bands, with their estimates counted
// (proc/estimate/channels.h).

#include "daemon/merging.h"

namespace gonio::daemon {

/// Of samples, with the averages that are asked for after that; of scattered values without any.
/// Usage error unless there is one of each of R, G, B, all samples or none.
[[nodiscard]] Result<Merged> mergedBands(const std::vector<MergeInput>& inputs,
                                         const MergeOptions& options);

/// theta_i,phi_i,theta_o,phi_o in degrees, f_*, u_* where any is known, flags_*.
[[nodiscard]] std::string channelCsv(const std::vector<proc::ChannelRow>& rows);

}  // namespace gonio::daemon
