#pragma once
// A latched fault, and what a person does about it.

#include <cstdint>
#include <string>

namespace gonio::daemon {

/// `fault` is a status code of the rig (PROTOCOL.md 2).
[[nodiscard]] std::string explained(std::uint16_t fault);

}  // namespace gonio::daemon
