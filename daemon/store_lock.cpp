#include "daemon/store_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace gonio::daemon {

Result<StoreLock> StoreLock::take(const std::filesystem::path& storeRoot) {
    const std::filesystem::path file = storeRoot / "rig.lock";
    StoreLock lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
    if (lock.descriptor_ < 0) {
        return Error{ErrorKind::Busy, "store: " + file.string() + ": " + std::strerror(errno)};
    }
    if (::flock(lock.descriptor_, LOCK_EX | LOCK_NB) != 0) {
        return Error{ErrorKind::Busy,
                     "store: another goniod has " + storeRoot.string() +
                         "; end it, or choose another with --store DIR"};
    }
    return lock;
}

StoreLock::StoreLock(StoreLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

StoreLock::~StoreLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace gonio::daemon
