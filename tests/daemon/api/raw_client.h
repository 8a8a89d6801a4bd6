#pragma once
// HTTP by hand on a UNIX socket: what no well-behaved client would send can be sent, and an answer
// is seen as it is.

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>

#include "tests/support/wait_until.h"

namespace gonio::test {

class RawConnection {
public:
    explicit RawConnection(const std::filesystem::path& socket) {
        sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
        const std::string path = socket.string();
        EXPECT_LT(path.size(), sizeof address.sun_path);
        std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
        descriptor_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        EXPECT_EQ(
            ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0)
            << path << ": " << std::strerror(errno);
    }
    ~RawConnection() { ::close(descriptor_); }
    RawConnection(const RawConnection&) = delete;
    RawConnection& operator=(const RawConnection&) = delete;

    /// All of it, unless the other side has gone.
    void send(std::string_view text) const {
        while (!text.empty()) {
            const ssize_t sent = ::send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL);
            if (sent <= 0) return;
            text.remove_prefix(static_cast<std::size_t>(sent));
        }
    }
    /// What comes until `mark` is in it, or the other side ends.
    std::string receiveUntil(std::string_view mark) const {
        std::string text;
        char bytes[4096];
        while (mark.empty() || text.find(mark) == std::string::npos) {
            pollfd ready{.fd = descriptor_, .events = POLLIN, .revents = 0};
            constexpr auto kWait = std::chrono::milliseconds(kPatience).count();
            if (::poll(&ready, 1, static_cast<int>(kWait)) <= 0) {
                ADD_FAILURE() << "no answer; so far: " << text;
                break;
            }
            const ssize_t got = ::recv(descriptor_, bytes, sizeof bytes, 0);
            if (got <= 0) break;
            text.append(bytes, static_cast<std::size_t>(got));
        }
        return text;
    }
    std::string receiveAll() const { return receiveUntil({}); }

private:
    int descriptor_ = -1;
};

struct RawAnswer {
    int status = 0;
    std::string head, body;
};

inline RawAnswer parseAnswer(const std::string& text) {
    RawAnswer answer;
    const std::size_t end = text.find("\r\n\r\n");
    answer.head = text.substr(0, end);
    if (end != std::string::npos) answer.body = text.substr(end + 4);
    if (answer.head.starts_with("HTTP/1.1 ")) answer.status = std::atoi(answer.head.c_str() + 9);
    return answer;
}

/// What a request says of itself.
struct RawRequest {
    std::string method = "GET";
    std::string target;
    std::string headers = "Host: localhost\r\n";
    std::string body{};
};

inline std::string requestText(const RawRequest& request) {
    return request.method + " " + request.target + " HTTP/1.1\r\n" + request.headers +
           "Content-Length: " + std::to_string(request.body.size()) + "\r\n\r\n" + request.body;
}

/// One request on a connection of its own.
inline RawAnswer askRaw(const std::filesystem::path& socket, RawRequest request) {
    request.headers += "Connection: close\r\n";
    const RawConnection connection(socket);
    connection.send(requestText(request));
    return parseAnswer(connection.receiveAll());
}

}  // namespace gonio::test
