#pragma once
// One block of LZ4's block format [LZ4block], decoded: tokens of literals and of copies from what
// was decoded before. Nothing is read or written outside the two sizes that are given.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::proc {

/// Exactly `size` bytes; empty where the block holds any other number of them, ends within a token
/// or copies from before its start.
[[nodiscard]] std::optional<std::string> decodeLz4(std::string_view block, std::size_t size);

}  // namespace gonio::proc
