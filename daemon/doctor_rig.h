#pragma once
// A rig from inside: asked, made to take two dark frames, and left dark. Who held a lapsed session
// of a rig that is claimed for it loses what the rig still kept for him.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/finding.h"
#include "daemon/profile.h"
#include "driver/rig.h"

namespace gonio::daemon {

/// identity, clock, temperature, interlock, self-test, noise, counters, link: one finding each, in
/// this order. The window is the whole sensor's afterwards. A rig that is lost meanwhile is a
/// failure of `link`.
[[nodiscard]] std::vector<Finding> examineClaimed(driver::Rig& rig, const RigProfile& profile);

/// The same of a rig that must not be asked now, by what it said last (empty: nothing yet); `why`
/// stands in notes for the rest.
[[nodiscard]] std::vector<Finding> examineUnasked(const driver::RigInfo& info,
                                                  const std::optional<driver::Status>& status,
                                                  const std::string& why);

/// A rig that is free: claim, then as examineClaimed(), and it is given back; after a claim that
/// fails, nothing more. `session` is as of LinkOptions.
[[nodiscard]] std::vector<Finding> examineInside(driver::Transport& transport,
                                                 std::uint64_t session,
                                                 const RigProfile& profile);

}  // namespace gonio::daemon
