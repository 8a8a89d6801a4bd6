#include "daemon/attendance.h"

#include <array>
#include <cstddef>

namespace gonio::daemon {
namespace {

constexpr std::array<std::string_view, 8> kCauses{
    "new-boot", "suspended", "repeated", "blank", "unlit", "exposure", "reflex", "rejected"};

}  // namespace

std::string_view name(Setback::Cause cause) { return kCauses[static_cast<std::size_t>(cause)]; }

}  // namespace gonio::daemon
