#pragma once
// One process at a time uses the rig of a store: a lock on the file rig.lock.

#include <filesystem>

#include "driver/file_lock.h"

namespace gonio::daemon {

/// Busy error, at once, when another process has it.
[[nodiscard]] Result<driver::FileLock> lockStore(const std::filesystem::path& storeRoot);

}  // namespace gonio::daemon
