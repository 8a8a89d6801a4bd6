#pragma once
// The udev rule that lets a person use a rig, in one place: what errors say, what `gonio doctor`
// prints and config/linux/70-gonio.rules hold the same lines (a test compares them).

#include <array>
#include <cstdint>
#include <string>

namespace gonio::driver {

inline constexpr const char* kUdevRuleFile = "/etc/udev/rules.d/70-gonio.rules";

/// Of the USB device and of its hidraw node, for rigs of these ids.
[[nodiscard]] std::array<std::string, 2> udevRule(std::uint16_t vendor, std::uint16_t product);
/// What somebody without permission does.
[[nodiscard]] std::string permissionCure(std::uint16_t vendor, std::uint16_t product);

}  // namespace gonio::driver
