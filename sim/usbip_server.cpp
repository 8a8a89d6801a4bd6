#include "sim/usbip_server.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

#include "sim/usbip_line.h"

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;
using usbip::ImportStatus;

constexpr std::size_t kMostConnections = 32;
constexpr Nanoseconds kPatience = 5s;  // with a client that asks half a request
constexpr int kLookMs = 50;

std::string why(int error) { return std::generic_category().message(error); }

struct FreeAddress {
    void operator()(addrinfo* info) const { freeaddrinfo(info); }
};
using Address = std::unique_ptr<addrinfo, FreeAddress>;

/// Empty where the host is no number.
Address numeric(const UsbipAddress& address) {
    addrinfo hints{};
    hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const std::string port = std::to_string(address.port);
    return Address(getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found) == 0 ? found
                                                                                        : nullptr);
}

int portOf(int descriptor) {
    sockaddr_storage own{};
    socklen_t length = sizeof own;
    getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &length);
    const auto port = own.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(own).sin6_port
                                                : reinterpret_cast<sockaddr_in&>(own).sin_port;
    return ntohs(port);
}

Error refused(const UsbipAddress& address, int error) {
    const std::string at = address.host + " port " + std::to_string(address.port);
    if (error == EADDRINUSE) {
        return {ErrorKind::Busy,
                "usbip: " + at + " is in use: end the other server, or choose another --port"};
    }
    if (error == EACCES) {
        return {ErrorKind::Busy, "usbip: " + at + " is not allowed: choose a --port above 1023"};
    }
    if (error == EADDRNOTAVAIL) {
        return {ErrorKind::Usage,
                "usbip: " + address.host +
                    " is no address of this computer: --bind wants one of `ip address`"};
    }
    return {ErrorKind::Busy, "usbip: " + at + ": " + why(error)};
}

Result<StreamSocket> listening(const UsbipAddress& address) {
    if (address.port < 0 || address.port > 65535) {
        return Error{ErrorKind::Usage,
                     "usbip: port " + std::to_string(address.port) + ": 0 to 65535 are there"};
    }
    const Address where = numeric(address);
    if (!where) {
        return Error{
            ErrorKind::Usage,
            "usbip: '" + address.host + "' is no address: --bind wants numbers, as 127.0.0.1"};
    }
    const int descriptor = socket(where->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) return refused(address, errno);
    StreamSocket listener(descriptor);
    const int yes = 1;
    setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (bind(descriptor, where->ai_addr, where->ai_addrlen) != 0 || listen(descriptor, 16) != 0)
        return refused(address, errno);
    return listener;
}

bool plugged(LiveRig& rig) {
    return rig.with([](FaultyUsb& usb) { return usb.plugged(); });
}

}  // namespace

usbip::Exported exported(LiveRig& rig, std::uint32_t number) {
    return rig.with([&](FaultyUsb& usb) {
        const bool super = usb.kind() == CameraKind::Usb3;
        const auto device = usb.deviceDescriptor();
        return usbip::Exported{
            .busId = "1-" + std::to_string(number),
            .bus = 1,
            .number = number,
            .speed = super ? usbip::Speed::Super : usbip::Speed::High,
            .vendor = usb.ids().vendor,
            .product = usb.ids().product,
            .release = static_cast<std::uint16_t>(device[12] | device[13] << 8),
            .interfaces = {{.ofClass = 3}, {.ofClass = 0xFF, .subclass = 0x47, .protocol = 1}}};
    });
}

Result<std::unique_ptr<UsbipServer>> UsbipServer::open(std::vector<LiveRig*> rigs,
                                                       const UsbipAddress& address,
                                                       Note note) {
    auto listener = listening(address);
    if (!listener) return listener.error();
    const int port = portOf(listener->descriptor());
    return std::unique_ptr<UsbipServer>(
        new UsbipServer(std::move(*listener), port, std::move(rigs), std::move(note)));
}

UsbipServer::UsbipServer(StreamSocket listener, int port, std::vector<LiveRig*> rigs, Note note)
    : listener_(std::move(listener)), port_(port), note_(std::move(note)) {
    const auto serial = [](LiveRig* rig) {
        return rig->with([](FaultyUsb& usb) { return usb.device().serial(); });
    };
    std::sort(
        rigs.begin(), rigs.end(), [&](LiveRig* a, LiveRig* b) { return serial(a) < serial(b); });
    for (LiveRig* rig : rigs) {
        Served& served = served_.emplace_back();
        served.rig = rig;
        served.serial = serial(rig);
        served.exported = exported(*rig, static_cast<std::uint32_t>(served_.size()));
    }
    acceptor_ = std::jthread([this](const std::stop_token& stop) { accept(stop); });
}

UsbipServer::~UsbipServer() {
    acceptor_.request_stop();
    acceptor_.join();
    for (Connection& connection : connections_) connection.thread.request_stop();
    connections_.clear();
}

std::vector<UsbipServer::Listed> UsbipServer::all() {
    std::vector<Listed> list;
    for (const Served& served : served_)
        list.push_back({.serial = served.serial, .busId = served.exported.busId});
    return list;
}

std::vector<usbip::Exported> UsbipServer::rigs() {
    std::vector<usbip::Exported> all;
    for (const Served& served : served_)
        if (plugged(*served.rig)) all.push_back(served.exported);
    return all;
}

void UsbipServer::tell(const std::string& line) {
    if (!note_) return;
    const std::scoped_lock lock(noteMutex_);
    note_(line);
}

void UsbipServer::accept(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        std::erase_if(connections_, [](const Connection& one) { return one.done.load(); });
        pollfd look{.fd = listener_.descriptor(), .events = POLLIN, .revents = 0};
        if (poll(&look, 1, kLookMs) <= 0) continue;
        const int client = accept4(listener_.descriptor(), nullptr, nullptr, SOCK_CLOEXEC);
        if (client < 0) {
            std::this_thread::sleep_for(10ms);  // out of descriptors: some client will leave
            continue;
        }
        StreamSocket socket(client);
        if (connections_.size() < kMostConnections) admit(std::move(socket));
    }
}

void UsbipServer::admit(StreamSocket socket) {
    const int yes = 1;
    setsockopt(socket.descriptor(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    socket.watchOtherEnd();
    Connection& connection = connections_.emplace_back();
    connection.thread = std::jthread(
        [this, &connection, socket = std::move(socket)](const std::stop_token& stop) mutable {
            converse(std::move(socket), stop);
            connection.done = true;
        });
}

void UsbipServer::converse(StreamSocket socket, const std::stop_token& stop) {
    usbip::Bytes inbox;
    std::array<std::uint8_t, 256> buffer{};
    const auto begin = std::chrono::steady_clock::now();
    while (!stop.stop_requested() && std::chrono::steady_clock::now() - begin < kPatience) {
        const auto request = usbip::readRequest(inbox);
        if (!request) return tell(request.error().message);
        if (*request) {
            const auto& [asked, length] = **request;
            inbox.erase(inbox.begin(), inbox.begin() + static_cast<std::ptrdiff_t>(length));
            if (asked.kind == usbip::Request::Kind::Import)
                return import(asked.busId, socket, std::move(inbox), stop);
            (void)socket.write(usbip::listReply(rigs()), kPatience, stop);
            return;
        }
        const auto read = socket.read(buffer, std::chrono::milliseconds(kLookMs));
        if (!read) return;
        inbox.insert(
            inbox.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*read));
    }
}

void UsbipServer::import(const std::string& busId,
                         StreamSocket& socket,
                         usbip::Bytes early,
                         const std::stop_token& stop) {
    const auto found = std::find_if(served_.begin(), served_.end(), [&](const Served& served) {
        return served.exported.busId == busId;
    });
    const auto refuse = [&](ImportStatus status) {
        (void)socket.write(usbip::importReply(status, {}), kPatience, stop);
    };
    if (found == served_.end() || !plugged(*found->rig)) return refuse(ImportStatus::NoDevice);
    if (found->taken.exchange(true)) return refuse(ImportStatus::Busy);
    tell(busId + " attached");
    {
        UsbipLine line(*found->rig, socket, std::move(early));
        Result<void> served;
        if (socket.write(usbip::importReply(ImportStatus::Ok, found->exported), kPatience, stop))
            served = line.serve(stop);
        tell(busId + " detached" + (served ? "" : ": " + served.error().message));
    }
    found->taken = false;
}

}  // namespace gonio::sim
