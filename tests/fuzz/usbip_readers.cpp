// A client of the USB/IP server that may say anything: to the codec, and to the whole server, over
// a socket of its own, with a simulated rig that is new each time. The rig's clock is no
// computer's: it goes on by a fixed step at each look, so that frames come and sessions lapse
// within milliseconds.

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <thread>

#include "sim/usbip_server.h"
#include "tests/fuzz/usb_readers.h"
#include "tests/support/usbip_frame.h"

namespace gonio::test {
namespace {

using namespace std::chrono_literals;
namespace usbip = sim::usbip;
using Bytes = usbip::Bytes;
using Span = std::span<const std::uint8_t>;

constexpr Nanoseconds kStep = 5ms;     // of the rig's clock
constexpr Nanoseconds kSilence = 3ms;  // then the client has heard all
constexpr Nanoseconds kPatience = 150ms;
constexpr std::size_t kMostHeard = std::size_t{4} << 20;

// ---- seeds: what a client says that means it well

using Talk = std::function<void(UsbipClient&, sim::LiveRig&)>;

std::string said(const Talk& talk) {
    sim::LiveRig rig({.errors = {}});
    auto server = sim::UsbipServer::open({&rig}, {.port = 0});
    if (!server) return {};
    UsbipClient client((*server)->port());
    talk(client, rig);
    return textOf(client.said());
}

/// As Linux makes a rig's acquaintance.
void enumerate(UsbipClient& client) {
    (void)client.import("1-1");
    (void)client.get(0x80, 6, 0x0100, 0, 64);
    (void)client.get(0x80, 6, 0x0200, 0, 9);
    (void)client.get(0x80, 6, 0x0200, 0, 255);
    for (const std::uint16_t string :
         std::array<std::uint16_t, 5>{0x0300, 0x0301, 0x0302, 0x0303, 0x03F0})
        (void)client.get(0x80, 6, string, 0x0409, 255);
    client.submit(false, 0, 0, UsbipClient::setup(0x00, 9, 1, 0, 0));
    (void)client.next(false);
    (void)client.get(0x81, 6, 0x2200, 0, 77);
    (void)client.get(0xA1, 1, 0x0301, 0, 64);
}

constexpr std::uint32_t kBuffer = 257 * 1024;

void readFrame(UsbipClient& client) {
    beginDarkFrame(client, {16, 8});
    for (int chunk = 0; chunk < 3; ++chunk) {
        client.submit(true, 2, kBuffer);
        (void)client.next(true);
    }
}

// ---- the server

struct Served {
    sim::LiveRig rig{{.errors = {}}, [now = Nanoseconds(0)]() mutable { return now += kStep; }};
    Result<std::unique_ptr<sim::UsbipServer>> server = sim::UsbipServer::open({&rig}, {.port = 0});
};

/// One for all inputs: to make a rig takes longer than to talk to it.
Served& served() {
    static Served served;
    served.rig.with([](sim::FaultyUsb& usb) {
        usb.unplug();
        usb.device().powerCycle();
        usb.plug();
    });
    return served;
}

// ---- what may be said and heard

struct Said {
    bool attached = false;
    std::vector<usbip::Command> commands;
};

/// What `read` makes of the bytes must be made of no fewer.
template <class Read>
std::optional<Error> needsAll(Span bytes, std::size_t length, Read read) {
    if (length == 0 || length > bytes.size()) return wrong("more was read than there is");
    const auto less = read(bytes.first(length - 1));
    if (!less || *less) return wrong("a message was read before it was whole");
    return std::nullopt;
}

Result<Said> understood(Span bytes) {
    Said all;
    while (!all.attached) {
        const auto next = usbip::readRequest(bytes);
        if (!next || !*next) return all;
        if (const auto bad = needsAll(bytes, (*next)->bytes, usbip::readRequest)) return *bad;
        if ((*next)->request.kind == usbip::Request::Kind::List) return all;
        if ((*next)->request.busId != "1-1") return all;
        bytes = bytes.subspan((*next)->bytes);
        all.attached = true;
    }
    while (true) {
        auto next = usbip::readCommand(bytes);
        if (!next || !*next) return all;
        if (const auto bad = needsAll(bytes, (*next)->bytes, usbip::readCommand)) return *bad;
        const auto& [command, length] = **next;
        if (command.submit.has_value() == command.unlink.has_value())
            return wrong("a command that is none, or two");
        if (command.submit && !command.submit->in &&
            command.submit->data.size() != command.submit->length)
            return wrong("a transfer without its data");
        bytes = bytes.subspan(length);
        all.commands.push_back(std::move((*next)->command));
    }
}

/// Everything that the server answers, until it is silent or gone.
Bytes heard(sim::StreamSocket& socket, Span left) {
    Bytes all;
    std::vector<std::uint8_t> buffer(std::size_t{64} << 10);
    const auto begin = std::chrono::steady_clock::now();
    while (all.size() < kMostHeard && std::chrono::steady_clock::now() - begin < kPatience) {
        if (!left.empty()) {
            const ssize_t sent =
                ::send(socket.descriptor(), left.data(), left.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            if (sent > 0) left = left.subspan(static_cast<std::size_t>(sent));
        }
        const auto got = socket.read(buffer, kSilence);
        if (!got || (*got == 0 && left.empty())) break;
        all.insert(all.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*got));
    }
    return all;
}

/// Each transfer is answered once at most, and with no more than it has room for.
std::optional<Error> notAnswers(const Said& said, Span bytes) {
    constexpr std::size_t kImportReply = 320;
    constexpr std::uint32_t kSubmitReply = 3, kUnlinkReply = 4;
    std::map<std::uint32_t, const usbip::Submit*> transfers;
    std::map<std::uint32_t, int> unlinks;
    for (const usbip::Command& command : said.commands) {
        if (command.unlink) {
            ++unlinks[command.unlink->sequence];
        } else if (!transfers.emplace(command.submit->sequence, &*command.submit).second) {
            return std::nullopt;  // two of a number: nobody knows which is answered
        }
    }
    if (bytes.size() < kImportReply) return std::nullopt;
    bytes = bytes.subspan(kImportReply);
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
        return value;
    };
    while (bytes.size() >= usbip::kCommandBytes) {
        const std::uint32_t command = word(0), sequence = word(4), actual = word(24);
        if (static_cast<std::int32_t>(word(20)) > 0) return wrong("a status above 0");
        std::size_t length = usbip::kCommandBytes;
        if (command == kUnlinkReply) {
            if (--unlinks[sequence] < 0) return wrong("an answer to no question");
        } else if (command == kSubmitReply) {
            const auto found = transfers.find(sequence);
            if (found == transfers.end()) return wrong("the end of no transfer, or its second");
            if (actual > found->second->length) return wrong("more than there is room for");
            if (found->second->in) length += actual;
            transfers.erase(found);
        } else {
            return wrong("an answer of no kind");
        }
        if (length > bytes.size()) break;  // the client did not wait for the rest
        bytes = bytes.subspan(length);
    }
    return std::nullopt;
}

}  // namespace

std::vector<std::string> soundConversations() {
    return {said([](UsbipClient& client, sim::LiveRig&) { client.list(); }),
            said([](UsbipClient& client, sim::LiveRig&) { enumerate(client); }),
            said([](UsbipClient& client, sim::LiveRig&) {
                (void)client.import("1-1");
                readFrame(client);
            }),
            said([](UsbipClient& client, sim::LiveRig&) {
                enumerate(client);
                client.submit(true, 1, 64);
                (void)client.next(true);
                const auto waiting = client.submit(true, 2, kBuffer);
                client.unlink(waiting);
                (void)client.next(false);
                readFrame(client);
                client.submit(false, 0, 0, UsbipClient::setup(0x01, 11, 0, 1, 0));
                (void)client.next(false);
            }),
            said([](UsbipClient& client, sim::LiveRig& rig) {
                (void)client.import("1-1");
                rig.with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::StallBulk); });
                beginDarkFrame(client, {16, 8});
                client.submit(true, 2, kBuffer);
                (void)client.next(true);
                client.submit(false, 0, 0, UsbipClient::setup(0x02, 1, 0, 0x82, 0));
                (void)client.next(false);
            })};
}

std::optional<Error> readUsbipCommands(std::string_view text) {
    const Bytes bytes = bytesOf(text);
    const auto all = understood(bytes);
    return all ? std::nullopt : std::optional(all.error());
}

std::optional<Error> readUsbipConversation(std::string_view text) {
    const Bytes bytes = bytesOf(text);
    const auto all = understood(bytes);
    if (!all) return all.error();
    const auto& server = served().server;
    if (!server) return wrong(server.error().message);
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return wrong("no pair of sockets");
    Bytes answers;
    {
        const std::jthread serving([&, theirs = ends[0]](const std::stop_token& stop) {
            (*server)->converse(sim::StreamSocket(theirs), stop);
        });
        sim::StreamSocket ours(ends[1]);
        answers = heard(ours, bytes);
    }
    return all->attached ? notAnswers(*all, answers) : std::nullopt;
}

}  // namespace gonio::test
