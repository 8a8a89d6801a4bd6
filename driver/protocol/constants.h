#pragma once
// The numbers of GRP/1 (docs/protocol.md): report ids, operations, states, statuses, events.

#include <cstdint>
#include <string>

namespace gonio::driver {

inline constexpr int kProtocolMajor = 1;
inline constexpr int kProtocolMinor = 0;
inline constexpr std::uint8_t kDarkLed = 255;
inline constexpr int kMaxLeds = 8;
inline constexpr std::int16_t kNoTemperature = -32768;

enum class ReportId : std::uint8_t {
    Ident = 0x01,
    Session = 0x02,
    LastAck = 0x03,
    Events = 0x04,
    Stats = 0x05,
    Limits = 0x06,
    Status = 0x10,
    Event = 0x11,
    Command = 0x20,
    Ack = 0x21,
};

enum class Op : std::uint8_t {
    Ping = 0x01,
    SetLed = 0x02,
    SetExposure = 0x03,
    SetFormat = 0x04,
    Arm = 0x05,
    Trigger = 0x06,
    Abort = 0x07,
    Resend = 0x08,
    Flush = 0x09,
    SyncTime = 0x0A,
    ClearFault = 0x0B,
    Reboot = 0x0C,
};

enum class RigState : std::uint8_t {
    Boot = 0,
    Idle = 1,
    Armed = 2,
    Exposing = 3,
    Fault = 4
};

enum class Owner : std::uint8_t {
    None = 0,
    Alive = 1,
    Lapsed = 2
};

enum class PixelFormat : std::uint8_t {
    Mono12Packed = 1,
    Mono16 = 2
};

namespace status {
inline constexpr std::uint16_t kOk = 0, kPending = 1;
inline constexpr std::uint16_t kBadArg = 101, kBadState = 102, kBadCrc = 103, kUnsupported = 104,
                               kNotOwner = 105, kBusy = 106, kBadSeq = 107;
inline constexpr std::uint16_t kInterlock = 201, kOverTemp = 202, kLedOpen = 203, kLedDrift = 204,
                               kSensor = 205, kHeartbeat = 206, kLink = 207;
inline constexpr std::uint16_t kOverrun = 301, kFrameGone = 302, kBadRange = 303;
inline constexpr std::uint16_t kInternal = 900;
}  // namespace status

/// "BAD_ARG", ...; "status N" where the number is unknown.
[[nodiscard]] std::string statusName(std::uint16_t status);
/// "SET_LED", ...; "op N" where the number is unknown.
[[nodiscard]] std::string opName(Op op);

namespace event {
inline constexpr std::uint16_t kBoot = 1, kInterlockOpened = 2, kInterlockClosed = 3, kOverTemp = 4,
                               kTemperatureBack = 5, kLedOpen = 6, kLedDrift = 7, kOverrun = 8,
                               kHeartbeatLost = 9, kModuleAttached = 10, kModuleRemoved = 11,
                               kClaimed = 12, kEnded = 13, kLinkLost = 14;
}  // namespace event

namespace interlock {
inline constexpr std::uint8_t kSeated = 1, kCoverClosed = 2, kModule = 4;
inline constexpr std::uint8_t kMayLight = kSeated | kCoverClosed;
/// By the bits of STATUS: the sample is seated, and the cover closed.
[[nodiscard]] constexpr bool mayLight(std::uint8_t bits) { return (bits & kMayLight) == kMayLight; }
}  // namespace interlock

namespace validity {
inline constexpr std::uint16_t kInterlock = 1, kCurrent = 2, kTemperature = 4;
inline constexpr std::uint16_t kAll = kInterlock | kCurrent | kTemperature;
}  // namespace validity

}  // namespace gonio::driver
