#pragma once
// A built `goniod` with a store of its own, from its start until it is ended or killed.

#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <iostream>
#include <optional>
#include <thread>

#include "tests/daemon/cli/program.h"

namespace gonio::test {

/// Somebody serves at this UNIX socket.
inline bool answersAt(const std::filesystem::path& socket) {
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    const std::string path = socket.string();
    if (path.size() >= sizeof address.sun_path) return false;
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const bool there =
        ::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::close(descriptor);
    return there;
}

class RunningDaemon {
public:
    /// Starts it and waits until it serves; a failed test when it does not.
    explicit RunningDaemon(const Program& program,
                           const std::vector<std::string>& arguments = {"--rig", "sim"})
        : program_(program) {
        std::vector<std::string> all{GONIO_DAEMON, "--store", (program / "store").string()};
        all.insert(all.end(), arguments.begin(), arguments.end());
        child_ = spawnProcess(all, program / "goniod.out", program / "goniod.err");
        constexpr auto kDeadline = std::chrono::seconds(20);
        const auto begin = std::chrono::steady_clock::now();
        while (!answersAt(program / "store/goniod.sock")) {
            const bool late = std::chrono::steady_clock::now() - begin > kDeadline;
            if (late || waitpid(child_, &status_, WNOHANG) != 0) {
                ADD_FAILURE() << "goniod does not serve: " << log();
                return;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }
    ~RunningDaemon() {
        const std::optional<int> ended = end(SIGKILL);
        if (!testing::Test::HasFailure()) return;
        std::cerr << "goniod ended " << ended.value_or(0) << " and said:\n" << log();
    }
    RunningDaemon(const RunningDaemon&) = delete;
    RunningDaemon& operator=(const RunningDaemon&) = delete;

    [[nodiscard]] pid_t pid() const { return child_; }
    /// What it said on stderr.
    [[nodiscard]] std::string log() const { return textOf(program_ / "goniod.err"); }
    /// Its exit code after this signal, or 128 + the signal that ended it; empty: ended before.
    std::optional<int> end(int signal = SIGTERM) {
        if (child_ <= 0) return std::nullopt;
        ::kill(child_, signal);
        waitpid(child_, &status_, 0);
        child_ = 0;
        return exitCodeOf(status_);
    }

private:
    const Program& program_;
    pid_t child_ = 0;
    int status_ = 0;
};

}  // namespace gonio::test
