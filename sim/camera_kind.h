#pragma once
// The cameras that a rig may have: what their USB carries sets how fast full frames come.
//   Usb2: high speed, 25 frames a second (one each 40 ms), 40 MB/s of bulk, packets of 512 bytes;
//   Usb3: SuperSpeed, 60 frames a second (one each 16 667 us), 400 MB/s, packets of 1024 bytes.
// The rates are what a host really gets, not the bit rate on the wire (radiometry.md 4).

#include <chrono>
#include <cstddef>

#include "proc/core/units.h"

namespace gonio::sim {

enum class CameraKind {
    Usb2,
    Usb3
};

struct CameraLink {
    Nanoseconds framePeriod{0};     ///< shortest, full frame
    double nanosecondsPerByte = 0;  ///< of the bulk stream
    std::size_t bulkPacket = 0;     ///< bytes
};

[[nodiscard]] constexpr CameraLink cameraLink(CameraKind kind) {
    using std::chrono::microseconds;
    if (kind == CameraKind::Usb3) return {microseconds(16'667), 2.5, 1024};
    return {microseconds(40'000), 25, 512};
}

}  // namespace gonio::sim
