#pragma once
// Every reader of bytes under one name, with small sound files to begin from: what tests that feed
// them damaged files, by hand or by libFuzzer, walk over.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"

namespace gonio::test {

struct Reader {
    std::string name;  ///< of the format, or "points", "sniff"
    std::vector<std::string> sound;
    bool text = true;
};

/// Those that this tree has.
[[nodiscard]] std::vector<Reader> readers();

/// What the reader says of the bytes: nothing where it takes them. What it takes is also asked for
/// its channels and incidences.
[[nodiscard]] std::optional<Error> complaintOf(std::string_view reader, std::string_view bytes);

}  // namespace gonio::test
