#include "daemon/store_lock.h"

namespace gonio::daemon {

Result<driver::FileLock> lockStore(const std::filesystem::path& storeRoot) {
    auto lock = driver::FileLock::take(storeRoot / "rig.lock",
                                       0644,
                                       "store: another goniod has " + storeRoot.string() +
                                           "; end it, or choose another with --store DIR");
    // A store that is another's is the usual reason.
    if (!lock && lock.error().kind != ErrorKind::Busy)
        return Error{ErrorKind::Busy, "store: " + lock.error().message};
    return lock;
}

}  // namespace gonio::daemon
