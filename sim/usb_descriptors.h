#pragma once
// What the rig tells a host of itself before anything else (PROTOCOL.md 1): USB 2.0 and HID 1.11,
// and for a camera of USB 3 the SuperSpeed forms of USB 3.2: endpoint companions and the BOS.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/camera_kind.h"

namespace gonio::sim {

struct UsbIds {
    std::uint16_t vendor = 0x1209;
    std::uint16_t product = 0x0001;
};

namespace usb {

inline constexpr std::uint8_t kHidInterface = 0, kStreamInterface = 1;
inline constexpr std::uint8_t kInterruptIn = 0x81, kInterruptOut = 0x01, kBulkIn = 0x82;

using Bytes = std::vector<std::uint8_t>;

[[nodiscard]] Bytes deviceDescriptor(const UsbIds& ids, CameraKind kind);
[[nodiscard]] Bytes configDescriptor(CameraKind kind);
/// Of a SuperSpeed device: what else it can do. Empty: a high-speed one has none.
[[nodiscard]] std::optional<Bytes> bosDescriptor(CameraKind kind);
/// Of a high-speed device at its other speed. Empty: at SuperSpeed there is none.
[[nodiscard]] std::optional<Bytes> qualifierDescriptor(CameraKind kind);
[[nodiscard]] std::span<const std::uint8_t> hidDescriptor();
[[nodiscard]] std::span<const std::uint8_t> reportDescriptor();
/// 0 names the language, 1 the maker, 2 the product, 3 the serial number, 240 the protocol; empty
/// for the rest.
[[nodiscard]] std::optional<Bytes> stringDescriptor(std::uint8_t index, const std::string& serial);

}  // namespace usb
}  // namespace gonio::sim
