#pragma once
// What has interrupted a job, as its event and its documents, and as a sample's file, say it.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "driver/comeback.h"

namespace gonio::daemon {

/// cause, lasted_s, same_boot, resent, redone; cut_off_done and rig_counters where they are known.
[[nodiscard]] nlohmann::ordered_json toJson(const driver::Interruption& interruption);
/// "2.1 s, same boot, 1 frame sent again, 3 redone: the rig is gone; ..."
[[nodiscard]] std::string described(const std::vector<driver::Interruption>& interruptions);

}  // namespace gonio::daemon
