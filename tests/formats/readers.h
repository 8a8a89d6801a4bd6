#pragma once
// Every reader of bytes under one name, with small sound files to begin from: what tests that feed
// them damaged files, by hand or by libFuzzer, walk over.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"

namespace gonio::test {

struct Reader {
    std::string_view name;  ///< of the format (proc/formats/format.h), or "stil", "points", "sniff"
    bool text = true;
    std::vector<std::string> (*sound)();
    /// What the reader says of the bytes: nothing where it takes them. What it takes is written by
    /// the format's writer, where there is one, and read again: an Internal error where that fails.
    std::optional<Error> (*complaint)(std::string_view bytes);
};

/// In the order of the formats.
[[nodiscard]] std::span<const Reader> readers();
/// Null for a name of none.
[[nodiscard]] const Reader* readerOf(std::string_view name);

}  // namespace gonio::test
