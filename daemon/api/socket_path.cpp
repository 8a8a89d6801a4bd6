#include "daemon/api/socket_path.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

}  // namespace

fs::path socketPath(const fs::path& chosen, const fs::path& store) {
    if (!chosen.empty()) return chosen;
    if (const char* set = std::getenv("GONIO_SOCKET"); set != nullptr && *set != '\0') return set;
    return store / "goniod.sock";
}

Result<void> checkSocketPath(const fs::path& socket) {
    constexpr std::size_t kLongest = sizeof(sockaddr_un::sun_path) - 1;
    if (socket.string().size() <= kLongest) return {};
    return Error{ErrorKind::Usage,
                 "socket " + socket.string() + ": longer than " + std::to_string(kLongest) +
                     " bytes; choose another with --socket PATH"};
}

Result<SocketClaim> SocketClaim::take(const fs::path& socket) {
    if (Result<void> good = checkSocketPath(socket); !good) return good.error();
    const std::string file = socket.string() + ".lock";
    SocketClaim claim(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600), {});
    if (claim.lock_ < 0) {
        const bool noPlace = errno == ENOENT || errno == ENOTDIR;
        return Error{noPlace ? ErrorKind::File : ErrorKind::Busy,
                     "socket " + file + ": " + std::strerror(errno)};
    }
    if (::flock(claim.lock_, LOCK_EX | LOCK_NB) != 0) {
        return Error{ErrorKind::Busy,
                     "socket " + socket.string() +
                         ": another goniod serves there; end it, or choose another with --socket "
                         "PATH"};
    }
    std::error_code ignored;
    if (fs::exists(socket, ignored) && !fs::is_socket(socket, ignored)) {
        return Error{ErrorKind::Busy, "socket " + socket.string() + ": a file is in its place"};
    }
    fs::remove(socket, ignored);
    claim.socket_ = socket;
    return claim;
}

SocketClaim::SocketClaim(SocketClaim&& other) noexcept
    : lock_(std::exchange(other.lock_, -1)), socket_(std::exchange(other.socket_, {})) {}

SocketClaim::~SocketClaim() {
    if (lock_ < 0) return;
    std::error_code ignored;
    if (!socket_.empty()) fs::remove(socket_, ignored);
    ::close(lock_);  // its file stays: removing it would let two daemons lock two files
}

}  // namespace gonio::daemon
