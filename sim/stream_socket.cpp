#include "sim/stream_socket.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace gonio::sim {
namespace {

constexpr Nanoseconds kLook = std::chrono::milliseconds(50);  // at whether to stop

/// True: what is waited for, or an end, is there.
bool ready(int descriptor, short events, Nanoseconds wait) {
    pollfd look{.fd = descriptor, .events = events, .revents = 0};
    const timespec limit{.tv_sec = wait.count() / 1'000'000'000,
                         .tv_nsec = wait.count() % 1'000'000'000};
    return ppoll(&look, 1, &limit, nullptr) > 0;
}

bool later(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

StreamSocket::StreamSocket(int descriptor) : descriptor_(descriptor) {
    fcntl(descriptor_, F_SETFL, fcntl(descriptor_, F_GETFL) | O_NONBLOCK);
    fcntl(descriptor_, F_SETFD, FD_CLOEXEC);
}

StreamSocket::~StreamSocket() {
    if (descriptor_ >= 0) close(descriptor_);
}

StreamSocket::StreamSocket(StreamSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

StreamSocket& StreamSocket::operator=(StreamSocket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

std::optional<std::size_t> StreamSocket::read(std::span<std::uint8_t> buffer, Nanoseconds wait) {
    if (!ready(descriptor_, POLLIN, wait)) return 0;
    const ssize_t got = recv(descriptor_, buffer.data(), buffer.size(), 0);
    if (got > 0) return static_cast<std::size_t>(got);
    if (got < 0 && later(errno)) return 0;
    return std::nullopt;
}

bool StreamSocket::write(std::span<const std::uint8_t> bytes,
                         Nanoseconds patience,
                         const std::stop_token& stop) {
    Nanoseconds waited{0};
    while (!bytes.empty()) {
        const ssize_t sent = send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent >= 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
            waited = Nanoseconds(0);
            continue;
        }
        if (!later(errno)) return false;
        const Nanoseconds step = std::min<Nanoseconds>(kLook, patience - waited);
        if (step <= Nanoseconds(0) || stop.stop_requested()) return false;
        if (!ready(descriptor_, POLLOUT, step)) waited += step;
    }
    return true;
}

void StreamSocket::watchOtherEnd() {
    constexpr int kYes = 1, kSilentS = 5, kAgainS = 2, kProbes = 3;
    constexpr unsigned kUnansweredMs = 1000 * (kSilentS + kAgainS * kProbes);
    const auto set = [this](int level, int name, const auto& value) {
        setsockopt(descriptor_, level, name, &value, sizeof value);
    };
    set(SOL_SOCKET, SO_KEEPALIVE, kYes);
    set(IPPROTO_TCP, TCP_KEEPIDLE, kSilentS);
    set(IPPROTO_TCP, TCP_KEEPINTVL, kAgainS);
    set(IPPROTO_TCP, TCP_KEEPCNT, kProbes);
    set(IPPROTO_TCP, TCP_USER_TIMEOUT, kUnansweredMs);
}

}  // namespace gonio::sim
