#pragma once
// One process at a time uses the rig of a store: a lock on the file rig.lock, which the kernel
// gives back however the process ends.

#include <filesystem>

#include "proc/core/result.h"

namespace gonio::daemon {

class StoreLock {
public:
    /// Busy error, at once, when another process has it.
    [[nodiscard]] static Result<StoreLock> take(const std::filesystem::path& storeRoot);
    ~StoreLock();
    StoreLock(StoreLock&& other) noexcept;
    StoreLock& operator=(StoreLock&&) = delete;

private:
    explicit StoreLock(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

}  // namespace gonio::daemon
