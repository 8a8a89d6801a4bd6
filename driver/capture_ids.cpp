#include "driver/capture_ids.h"

#include <algorithm>

namespace gonio::driver {
namespace {

// As many as frame RAM holds frames, and so captures. A rig that holds more refuses the id, and the
// next is tried.
constexpr std::size_t kRemembered = 8;
constexpr std::uint16_t kMostAttempts = 0xFFFF;

}  // namespace

CaptureIds::CaptureIds() { recent_.reserve(kRemembered + 1); }

std::uint64_t CaptureIds::next(std::uint64_t planStep) {
    Used used{.planStep = planStep};
    const auto known = std::find_if(
        recent_.begin(), recent_.end(), [&](const Used& u) { return u.planStep == planStep; });
    if (known != recent_.end()) {
        used = *known;
        recent_.erase(known);
    }
    used.attempt = static_cast<std::uint16_t>(used.attempt == kMostAttempts ? 1 : used.attempt + 1);
    recent_.push_back(used);
    if (recent_.size() > kRemembered) recent_.erase(recent_.begin());
    return planStep << kAttemptBits | used.attempt;
}

}  // namespace gonio::driver
