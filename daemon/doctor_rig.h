#pragma once
// A rig from inside: it is claimed, asked, made to take two dark frames, and given back dark. Needs
// the rig to be free. Who held a lapsed session of it loses what the rig still kept for him.

#include <cstdint>
#include <vector>

#include "daemon/finding.h"
#include "daemon/profile.h"
#include "driver/protocol/transport.h"

namespace gonio::daemon {

/// claim, clock, temperature, interlock, self-test, noise, counters: one finding each, in this
/// order; after a claim that fails, nothing more. `session` is as of LinkOptions.
[[nodiscard]] std::vector<Finding> examineInside(driver::Transport& transport,
                                                 std::uint64_t session,
                                                 const RigProfile& profile);

}  // namespace gonio::daemon
