#pragma once
// What driver_fuzz reads of the bus: descriptors through libusb's own parser, and what a client
// says to the USB/IP server.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"

namespace gonio::test {

inline std::vector<std::uint8_t> bytesOf(std::string_view text) {
    return {text.begin(), text.end()};
}

inline std::string textOf(std::span<const std::uint8_t> bytes) {
    return {bytes.begin(), bytes.end()};
}

/// Ours to mend, whatever the bytes are.
inline Error wrong(const std::string& what) { return {ErrorKind::Internal, what}; }

/// Two bytes, the length of the device's and its configurations' descriptors; these; and what it
/// answers to whoever asks it for others.
[[nodiscard]] std::vector<std::string> soundDescriptors();
[[nodiscard]] std::optional<Error> readDescriptors(std::string_view text);

/// All that a client says on one connection.
[[nodiscard]] std::vector<std::string> soundConversations();
/// Through the codec alone.
[[nodiscard]] std::optional<Error> readUsbipCommands(std::string_view text);
/// Said to a server with a simulated rig, whose time runs faster than the computer's.
[[nodiscard]] std::optional<Error> readUsbipConversation(std::string_view text);

}  // namespace gonio::test
