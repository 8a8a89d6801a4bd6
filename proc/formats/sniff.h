#pragma once
// What a file is, by its content first and its name last: `.bsdf` alone names three formats, and
// so does `.csv`.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/format.h"

namespace gonio::proc {

/// `head` is the beginning of the file (64 KiB are enough), `bytes` its size; `path` is asked last.
/// Empty for what is none of the formats.
[[nodiscard]] std::optional<Format> sniff(std::string_view head,
                                          std::uintmax_t bytes,
                                          const std::filesystem::path& path);

/// File error for a file that is not there or is none of the formats.
[[nodiscard]] Result<Format> sniffFile(const std::filesystem::path& path);

}  // namespace gonio::proc
