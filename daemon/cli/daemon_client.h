#pragma once
// The daemon as its clients see it. An error of the daemon's comes back with its kind; without a
// daemon at the socket everything is NoRig, and the message says how to start one.

#include <filesystem>
#include <functional>
#include <string>

#include "daemon/cli/event_stream.h"
#include "proc/core/result.h"

namespace gonio::daemon {

class DaemonClient {
public:
    /// Asks nothing yet.
    explicit DaemonClient(std::filesystem::path socket) : socket_(std::move(socket)) {}

    /// The body of the answer: JSON, or a file's bytes.
    [[nodiscard]] Result<std::string> get(const std::string& path) const;
    Result<std::string> post(const std::string& path, const std::string& json) const;

    /// Hands on the events after number `after` until `on` says no. `idle` is asked at least each
    /// second, and says whether to go on. False: the daemon ended the stream.
    Result<bool> follow(std::uint64_t after,
                        const std::function<bool(const StreamEvent&)>& on,
                        const std::function<bool()>& idle) const;

private:
    [[nodiscard]] Error unreachable(bool answered) const;
    std::filesystem::path socket_;
};

}  // namespace gonio::daemon
