#pragma once
// The API over HTTP on a UNIX socket that only its owner (or group) may open, and events as
// server-sent events: GET /api/v1/events, from Last-Event-ID (or ?after=) on. 64 threads, at most
// 16 event streams, bodies up to 1 MiB; a request must say that it is meant for this host.

#include <filesystem>
#include <memory>

#include "daemon/api/api.h"
#include "daemon/api/socket_path.h"

namespace gonio::daemon {

class HttpServer {
public:
    /// Serves until it is destroyed, in threads of its own. `engine` is borrowed; its events must
    /// be closed before, or an open stream holds the server up for a second.
    [[nodiscard]] static Result<std::unique_ptr<HttpServer>> open(
        const std::filesystem::path& socket,
        Engine& engine,
        SocketAccess access = SocketAccess::User);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

private:
    class Impl;
    explicit HttpServer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace gonio::daemon
