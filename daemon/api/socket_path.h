#pragma once
// Where a daemon and its clients meet: a UNIX socket, one for each store.

#include <filesystem>

#include "proc/core/result.h"

namespace gonio::daemon {

/// `chosen`; where that is empty $GONIO_SOCKET, else goniod.sock in the store.
[[nodiscard]] std::filesystem::path socketPath(const std::filesystem::path& chosen,
                                               const std::filesystem::path& store);

/// Usage error for a path that no UNIX socket can have.
[[nodiscard]] Result<void> checkSocketPath(const std::filesystem::path& socket);

/// Who may connect.
enum class SocketAccess {
    User,  ///< 0600
    Group  ///< 0660
};

/// The right to serve at a socket: held while this lives, the socket's file removed with it.
class SocketClaim {
public:
    /// Busy when another daemon serves there, or something else is in its place; File error without
    /// the folder. What a daemon that was killed left behind is removed.
    [[nodiscard]] static Result<SocketClaim> take(const std::filesystem::path& socket);
    SocketClaim(SocketClaim&& other) noexcept;
    SocketClaim& operator=(SocketClaim&&) = delete;
    ~SocketClaim();

private:
    SocketClaim(int lock, std::filesystem::path socket) : lock_(lock), socket_(std::move(socket)) {}
    int lock_;
    std::filesystem::path socket_;
};

}  // namespace gonio::daemon
