#pragma once
// A file that one process at a time may have; the kernel gives it back however the process ends.

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "proc/core/result.h"

namespace gonio::driver {

class FileLock {
public:
    /// Makes the file with this mode where there is none. At once: Busy, with the words `held`,
    /// when another process has it, or another owner in this one; File when it cannot be opened
    /// or its file system knows no locks.
    [[nodiscard]] static Result<FileLock> take(const std::filesystem::path& file,
                                               mode_t mode,
                                               const std::string& held);
    ~FileLock();
    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&&) = delete;

private:
    explicit FileLock(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

}  // namespace gonio::driver
