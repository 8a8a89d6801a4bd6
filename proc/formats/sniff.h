#pragma once
// What a file is, by its content first and its name last: `.bsdf` alone names three formats.

#include <filesystem>
#include <string_view>

#include "proc/core/result.h"

namespace gonio::proc {

enum class FileKind {
    Gonio,
    Graw,
    Zemax,
    PointsCsv,   ///< pairs of directions, with or without f
    LightTools,  ///< recognised only to be named in an error
    Rgl,         ///< likewise
    OtherExr,    ///< an OpenEXR picture that is not ours
    Unknown,
};

/// "Zemax BSDF", ...: for messages.
[[nodiscard]] std::string_view name(FileKind kind);

/// `head` is the beginning of the file (64 KiB are enough), `path` is asked last.
[[nodiscard]] FileKind sniff(std::string_view head, const std::filesystem::path& path);
[[nodiscard]] Result<FileKind> sniffFile(const std::filesystem::path& path);

}  // namespace gonio::proc
