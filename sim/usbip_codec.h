#pragma once
// USB/IP 1.1.1 as bytes (kernel Documentation/usb/usbip_protocol): what a client asks before a rig
// is attached, and the transfers after it. All numbers are big-endian, the setup of a control
// transfer excepted. Nothing here trusts a length: what no rig could answer is an error, and the
// connection ends with it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proc/core/result.h"

namespace gonio::sim::usbip {

using Bytes = std::vector<std::uint8_t>;

inline constexpr std::uint16_t kVersion = 0x0111;
inline constexpr std::size_t kBusIdBytes = 32;
inline constexpr std::size_t kCommandBytes = 48;
inline constexpr std::size_t kRequestBytes = 8;
/// The longest data stage of a control transfer; no other transfer to a rig is longer.
inline constexpr std::uint32_t kMostOut = 65535;
/// What usbfs grants to all its users together.
inline constexpr std::uint32_t kMostIn = 16U << 20;

/// Before a rig is attached.
struct Request {
    enum class Kind {
        List,
        Import
    };
    Kind kind = Kind::List;
    std::string busId{};  ///< of Import
};

/// Of the reply to an import.
enum class ImportStatus : std::uint32_t {
    Ok = 0,
    Busy = 2,
    NoDevice = 4
};

enum class Speed : std::uint32_t {
    High = 3,
    Super = 5
};

struct InterfaceClass {
    std::uint8_t ofClass = 0, subclass = 0, protocol = 0;
};

/// A rig as it is listed.
struct Exported {
    std::string busId;
    std::uint32_t bus = 1;
    std::uint32_t number = 1;
    Speed speed = Speed::High;
    std::uint16_t vendor = 0, product = 0, release = 0;
    std::vector<InterfaceClass> interfaces;
};

/// A transfer that the client submits.
struct Submit {
    std::uint32_t sequence = 0;
    bool in = false;
    std::uint8_t endpoint = 0;
    bool shortNotOk = false;
    std::uint32_t length = 0;
    std::array<std::uint8_t, 8> setup{};
    Bytes data{};  ///< of a transfer to the rig
};

/// The client takes a transfer back.
struct Unlink {
    std::uint32_t sequence = 0;
    std::uint32_t victim = 0;
};

struct Command {
    std::optional<Submit> submit{};
    std::optional<Unlink> unlink{};
};

/// How a transfer ended: `status` is 0 or a negative errno.
struct Ended {
    std::uint32_t sequence = 0;
    int status = 0;
    std::uint32_t actual = 0;
};

/// The request that `bytes` begin with and its length; empty: more bytes are needed.
struct ReadRequest {
    Request request;
    std::size_t bytes = 0;
};
[[nodiscard]] Result<std::optional<ReadRequest>> readRequest(std::span<const std::uint8_t> bytes);

/// The command that `bytes` begin with, its data included; empty: more bytes are needed.
struct ReadCommand {
    Command command;
    std::size_t bytes = 0;
};
[[nodiscard]] Result<std::optional<ReadCommand>> readCommand(std::span<const std::uint8_t> bytes);

[[nodiscard]] Bytes listReply(std::span<const Exported> rigs);
/// Anything but Ok goes without the rig.
[[nodiscard]] Bytes importReply(ImportStatus status, const Exported& rig);
/// The data of a transfer from the rig follow it.
[[nodiscard]] std::array<std::uint8_t, kCommandBytes> submitReply(const Ended& ended);
[[nodiscard]] std::array<std::uint8_t, kCommandBytes> unlinkReply(std::uint32_t sequence,
                                                                  int status);

}  // namespace gonio::sim::usbip
