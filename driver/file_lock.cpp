#include "driver/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace gonio::driver {

Result<FileLock> FileLock::take(const std::filesystem::path& file,
                                mode_t mode,
                                const std::string& held) {
    FileLock lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, mode));
    if (lock.descriptor_ < 0)
        return Error{ErrorKind::File, file.string() + ": " + std::strerror(errno)};
    if (::flock(lock.descriptor_, LOCK_EX | LOCK_NB) == 0) return lock;
    if (errno == EWOULDBLOCK) return Error{ErrorKind::Busy, held};
    return Error{ErrorKind::File, file.string() + ": cannot be locked: " + std::strerror(errno)};
}

FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock::~FileLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace gonio::driver
