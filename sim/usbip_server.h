#pragma once
// Simulated rigs for the network: each is listed under a bus id (1-1, 1-2, ... in the order of
// their serial numbers) and serves one client at a time, in a thread of that connection. USB/IP
// knows no passwords: who reaches the port has the rigs, so the port is loopback's unless told
// otherwise.

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "sim/live_rig.h"
#include "sim/stream_socket.h"
#include "sim/usbip_codec.h"

namespace gonio::sim {

/// What the descriptors of a rig say, as USB/IP lists it.
[[nodiscard]] usbip::Exported exported(LiveRig& rig, std::uint32_t number);

struct UsbipAddress {
    std::string host = "127.0.0.1";  ///< a number: no name is looked up
    int port = 3240;                 ///< 0: a free one
};

class UsbipServer {
public:
    /// What happens, in a line: who attached, who did what wrong. From threads of the server.
    using Note = std::function<void(const std::string& line)>;

    /// The rigs are borrowed. No number, or a port out of range: Usage; in use, or not allowed:
    /// Busy.
    [[nodiscard]] static Result<std::unique_ptr<UsbipServer>> open(std::vector<LiveRig*> rigs,
                                                                   const UsbipAddress& address,
                                                                   Note note = {});
    ~UsbipServer();
    UsbipServer(const UsbipServer&) = delete;
    UsbipServer& operator=(const UsbipServer&) = delete;

    [[nodiscard]] int port() const { return port_; }
    /// All that it serves, also those that are not plugged in.
    struct Listed {
        std::string serial, busId;
    };
    [[nodiscard]] std::vector<Listed> all();
    /// Those that are plugged in.
    [[nodiscard]] std::vector<usbip::Exported> rigs();
    /// Serves one client more, who came another way, in the caller's thread until that one is gone.
    void converse(StreamSocket socket, const std::stop_token& stop);

private:
    struct Served {
        LiveRig* rig = nullptr;
        std::string serial;
        usbip::Exported exported;
        std::atomic<bool> taken{false};
    };
    struct Connection {
        std::atomic<bool> done{false};
        std::jthread thread;
    };
    UsbipServer(StreamSocket listener, int port, std::vector<LiveRig*> rigs, Note note);
    void accept(const std::stop_token& stop);
    void admit(StreamSocket socket);
    void import(const std::string& busId,
                StreamSocket& socket,
                usbip::Bytes early,
                const std::stop_token& stop);
    void tell(const std::string& line);

    StreamSocket listener_;
    int port_;
    std::list<Served> served_;
    std::mutex noteMutex_;
    Note note_;
    std::list<Connection> connections_;  ///< of the accepting thread
    std::jthread acceptor_;
};

}  // namespace gonio::sim
