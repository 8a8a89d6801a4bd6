#pragma once
// Whole files in and out of memory, with every failure told: what, which file, why. A reader never
// takes more than its limit, and never a directory or a device.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "proc/core/result.h"

namespace gonio::proc {

/// No measured BRDF that we know comes near this.
inline constexpr std::size_t kLargestFile = std::size_t{512} << 20U;

/// The bytes of a regular file; File error where it is missing, unreadable or larger than `limit`.
[[nodiscard]] Result<std::string> readFile(const std::filesystem::path& path,
                                           std::size_t limit = kLargestFile);
/// At most the first `count` bytes, from a file of any size.
[[nodiscard]] Result<std::string> readHead(const std::filesystem::path& path, std::size_t count);
/// Replaces the file; a pipe or a device is written into. A failed write (full disk) is a File
/// error, leaves the old file as it was, and no half file behind: the bytes go into PATH.part,
/// which takes the name only when it is whole. It is not synced to the disk: files that are written
/// here can be made again, and a sync costs tens of milliseconds each. After a power cut the name
/// may stand for the old file, the new one or, on some file systems, an empty one; what must
/// survive that is in the daemon's store, which does sync.
[[nodiscard]] Result<void> writeFile(const std::filesystem::path& path, std::string_view bytes);

}  // namespace gonio::proc
