#pragma once
// A USB/IP client written from the protocol's description alone, for tests: it shares no code with
// the server.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace gonio::test {

class UsbipClient {
public:
    using Bytes = std::vector<std::uint8_t>;

    explicit UsbipClient(int port) : descriptor_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ =
            connect(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    }
    ~UsbipClient() { leave(); }
    UsbipClient(const UsbipClient&) = delete;
    UsbipClient& operator=(const UsbipClient&) = delete;

    void leave() {
        if (descriptor_ >= 0) close(descriptor_);
        descriptor_ = -1;
    }
    [[nodiscard]] bool connected() const { return connected_; }
    void send(const Bytes& bytes) const {
        said_.insert(said_.end(), bytes.begin(), bytes.end());
        (void)!::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }
    /// All that was sent.
    [[nodiscard]] const Bytes& said() const { return said_; }
    /// Exactly so many, or fewer when the server ends the connection or is silent for long.
    [[nodiscard]] Bytes receive(std::size_t count,
                                std::chrono::milliseconds wait = std::chrono::seconds(20)) const {
        Bytes bytes;
        std::array<std::uint8_t, 4096> buffer{};
        while (bytes.size() < count) {
            pollfd look{.fd = descriptor_, .events = POLLIN, .revents = 0};
            if (poll(&look, 1, static_cast<int>(wait.count())) <= 0) break;
            const ssize_t got =
                recv(descriptor_, buffer.data(), std::min(buffer.size(), count - bytes.size()), 0);
            if (got <= 0) break;
            bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + got);
        }
        return bytes;
    }
    /// The server has ended the connection.
    [[nodiscard]] bool ended() const { return receive(1).empty(); }

    static void put(Bytes& bytes, std::uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8)
            bytes.push_back(static_cast<std::uint8_t>(value >> shift & 0xFF));
    }
    static std::uint32_t word(const Bytes& bytes, std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes.at(at + i);
        return value;
    }
    static Bytes words(std::initializer_list<std::uint32_t> values) {
        Bytes bytes;
        for (const std::uint32_t value : values) put(bytes, value);
        return bytes;
    }

    void list() const { send(words({0x01118005, 0})); }
    /// The status of the reply; 0: attached.
    [[nodiscard]] std::uint32_t import(const std::string& busId) const {
        Bytes request = words({0x01118003, 0});
        for (std::size_t i = 0; i < 32; ++i)
            request.push_back(i < busId.size() ? static_cast<std::uint8_t>(busId[i]) : 0);
        send(request);
        const Bytes head = receive(8);
        if (head.size() < 8) return 0xFFFFFFFF;
        const std::uint32_t status = word(head, 4);
        if (status == 0 && receive(312).size() != 312) return 0xFFFFFFFE;
        return status;
    }

    struct Ended {
        std::uint32_t command = 0;  ///< 3: a transfer ended, 4: one was taken back
        std::uint32_t sequence = 0;
        int status = 0;
        Bytes data{};
    };
    using Setup = std::array<std::uint8_t, 8>;
    /// Its sequence number.
    std::uint32_t submit(bool in,
                         std::uint32_t endpoint,
                         std::uint32_t length,
                         const Setup& setup = {},
                         const Bytes& data = {}) {
        Bytes bytes =
            words({1, ++sequence_, 0x10001, in ? 1U : 0U, endpoint, 0, length, 0, 0xFFFFFFFF, 0});
        bytes.insert(bytes.end(), setup.begin(), setup.end());
        bytes.insert(bytes.end(), data.begin(), data.end());
        send(bytes);
        return sequence_;
    }
    std::uint32_t unlink(std::uint32_t victim) {
        Bytes bytes = words({2, ++sequence_, 0x10001, 0, 0, victim});
        bytes.resize(48);
        send(bytes);
        return sequence_;
    }
    /// The next thing that the server says. `in`: a transfer from the rig brings data.
    [[nodiscard]] Ended next(bool in) const {
        const Bytes head = receive(48);
        if (head.size() < 48) return {};
        Ended ended{.command = word(head, 0),
                    .sequence = word(head, 4),
                    .status = static_cast<int>(word(head, 20))};
        if (ended.command == 3 && in) ended.data = receive(word(head, 24));
        return ended;
    }
    /// A control transfer from the rig.
    [[nodiscard]] Ended get(std::uint8_t type,
                            std::uint8_t request,
                            std::uint16_t value,
                            std::uint16_t index,
                            std::uint16_t length) {
        submit(true, 0, length, setup(type, request, value, index, length));
        return next(true);
    }
    [[nodiscard]] static Setup setup(std::uint8_t type,
                                     std::uint8_t request,
                                     std::uint16_t value,
                                     std::uint16_t index,
                                     std::uint16_t length) {
        const auto low = [](std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFF); };
        const auto high = [](std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); };
        return {type,
                request,
                low(value),
                high(value),
                low(index),
                high(index),
                low(length),
                high(length)};
    }

private:
    int descriptor_;
    mutable Bytes said_{};
    bool connected_ = false;
    std::uint32_t sequence_ = 0;
};

}  // namespace gonio::test
