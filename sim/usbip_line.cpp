#include "sim/usbip_line.h"

#include <algorithm>
#include <cerrno>
#include <utility>

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;
using usbip::Submit;

constexpr std::size_t kMostWaiting = 1024;  // transfers: 16 MiB of usbfs in pieces of 16 KiB
constexpr std::size_t kMostReports = 16;    // that nobody has fetched: the oldest are lost
constexpr std::size_t kReadAtOnce = std::size_t{64} << 10;
constexpr Nanoseconds kPatience = 5s;
constexpr Nanoseconds kLook = 1ms;  // how often the rig is asked again: a USB frame
constexpr Nanoseconds kIdle = 10ms;

Error gone() { return {ErrorKind::Interrupted, "usbip: the client is gone"}; }

UsbSetup setupOf(const Submit& submit) {
    const auto word = [&](std::size_t i) {  // as on the bus: little-endian
        return static_cast<std::uint16_t>(submit.setup[i] | submit.setup[i + 1] << 8);
    };
    return {.requestType = submit.setup[0],
            .request = submit.setup[1],
            .value = word(2),
            .index = word(4),
            .length = word(6)};
}

/// USB/IP does not tell of a bus reset. Linux follows it with a request for 64 bytes of the device
/// descriptor, of a SuperSpeed device 8, which nobody else makes.
UsbReply control(FaultyUsb& usb, const UsbSetup& setup, std::span<const std::uint8_t> out) {
    const std::uint16_t first = usb.kind() == CameraKind::Usb3 ? 8 : 64;
    const bool enumerates = setup.requestType == 0x80 && setup.request == 6 &&
                            setup.value == 0x0100 && setup.length == first;
    if (enumerates) usb.resetPort();
    return usb.control(setup, out);
}

}  // namespace

UsbipLine::UsbipLine(LiveRig& rig,
                     StreamSocket& socket,
                     usbip::Bytes early,
                     std::optional<int> pulls)
    : rig_(rig),
      socket_(socket),
      inbox_(std::move(early)),
      pulls_(pulls ? *pulls : rig.with([](FaultyUsb& usb) { return usb.pulls(); })) {
    rig_.listen([this](const std::vector<std::uint8_t>& report) {
        const std::scoped_lock lock(mutex_);
        // Of a stalled endpoint one transfer is told; the next one after that is told again.
        if (report.empty() && !reports_.empty() && reports_.back().empty()) return;
        if (reports_.size() == kMostReports) reports_.pop_front();
        reports_.push_back(report);
    });
}

UsbipLine::~UsbipLine() {
    rig_.listen({});
    rig_.with([](FaultyUsb& usb) { usb.resetPort(); });
}

bool UsbipLine::pulled() {
    return rig_.with([this](FaultyUsb& usb) { return !usb.plugged() || usb.pulls() != pulls_; });
}

bool UsbipLine::idle() const {
    return std::all_of(
        waiting_.begin(), waiting_.end(), [](const auto& queue) { return queue.empty(); });
}

Result<void> UsbipLine::serve(const std::stop_token& stop) {
    stop_ = stop;
    usbip::Bytes buffer(kReadAtOnce);
    bool busy = true;
    while (!stop.stop_requested() && !pulled()) {
        const auto read = socket_.read(buffer, busy ? 0ns : idle() ? kIdle : kLook);
        if (!read) return {};
        inbox_.insert(
            inbox_.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*read));
        if (auto taken = takeCommands(); !taken) return taken;
        const auto ended = advance();
        if (!ended) return ended.error();
        busy = *ended;
    }
    breakTransfers();
    return {};
}

/// As a cable ends those in flight that is pulled, most often, a moment before the device is gone.
void UsbipLine::breakTransfers() {
    if (!pulled() || rig_.with([](FaultyUsb& usb) { return usb.quietlyPulled(); })) return;
    for (const auto& queue : waiting_)
        for (const Submit& submit : queue) (void)end(submit, {.status = -EPROTO});
}

Result<void> UsbipLine::takeCommands() {
    std::size_t taken = 0;
    while (true) {
        auto next = usbip::readCommand(std::span(inbox_).subspan(taken));
        if (!next) return next.error();
        if (!*next) break;
        usbip::ReadCommand& read = **next;
        taken += read.bytes;
        auto done = read.command.submit ? take(std::move(*read.command.submit))
                                        : take(*read.command.unlink);
        if (!done) return done;
    }
    inbox_.erase(inbox_.begin(), inbox_.begin() + static_cast<std::ptrdiff_t>(taken));
    return {};
}

std::optional<UsbipLine::Queue> UsbipLine::queueOf(const Submit& submit) {
    if (submit.endpoint == 0) return kControl;
    switch (submit.endpoint | (submit.in ? 0x80 : 0)) {
        case usb::kInterruptIn: return kInterruptIn;
        case usb::kInterruptOut: return kInterruptOut;
        case usb::kBulkIn: return kBulkIn;
        default: return std::nullopt;
    }
}

Result<void> UsbipLine::take(Submit submit) {
    const auto queue = queueOf(submit);
    if (!queue) return end(submit, {.status = -EPIPE});
    if (waiting_[*queue].size() == kMostWaiting) {
        return Error{
            ErrorKind::Device,
            "usbip: more than " + std::to_string(kMostWaiting) + " transfers wait at one endpoint"};
    }
    if (*queue == kInterruptIn) reopenReports();
    waiting_[*queue].push_back(std::move(submit));
    return {};
}

/// A driver that closes the reports takes all back that waits for them.
void UsbipLine::reopenReports() {
    if (!std::exchange(reportsClosed_, false)) return;
    rig_.with([](FaultyUsb& usb) { usb.reportsOpened(); });
}

Result<void> UsbipLine::take(const usbip::Unlink& unlink) {
    bool found = false;
    const bool listened = !waiting_[kInterruptIn].empty();
    for (auto& queue : waiting_) {
        found = std::erase_if(
                    queue, [&](const Submit& submit) { return submit.sequence == unlink.victim; }) >
                    0 ||
                found;
    }
    if (listened && waiting_[kInterruptIn].empty()) reportsClosed_ = true;
    return send(usbip::unlinkReply(unlink.sequence, found ? -ECONNRESET : 0));
}

/// One transfer of each endpoint at most: a stream without pause leaves time to read commands.
Result<bool> UsbipLine::advance() {
    bool any = false;
    for (std::size_t i = 0; i < kQueues; ++i) {
        auto& queue = waiting_[i];
        if (queue.empty()) continue;
        auto how = outcome(static_cast<Queue>(i), queue.front());
        if (!how) continue;
        const Submit submit = std::move(queue.front());
        queue.pop_front();
        if (auto sent = end(submit, std::move(*how)); !sent) return sent.error();
        any = true;
    }
    return any;
}

std::optional<UsbipLine::Outcome> UsbipLine::nextReport() {
    const std::scoped_lock lock(mutex_);
    if (reports_.empty()) return std::nullopt;
    Outcome next{.data = std::move(reports_.front())};
    if (next.data.empty()) next.status = -EPIPE;
    reports_.pop_front();
    return next;
}

std::optional<UsbipLine::Outcome> UsbipLine::outcome(Queue queue, const Submit& submit) {
    if (rig_.faults.hung) return std::nullopt;
    if (queue == kInterruptIn) return nextReport();
    bool wholePackets = true;
    UsbReply reply = rig_.with([&](FaultyUsb& usb) -> UsbReply {
        switch (queue) {
            case kControl: return control(usb, setupOf(submit), submit.data);
            case kInterruptOut: return usb.interruptOut(submit.data);
            default:
                wholePackets = submit.length % usb.bulkPacket() == 0;
                return usb.bulkIn(submit.length);
        }
    });
    // A buffer that ends inside a packet has no room for a full one.
    if (reply.answer == UsbAnswer::Done && !wholePackets) return Outcome{.status = -EOVERFLOW};
    switch (reply.answer) {
        case UsbAnswer::Done: return Outcome{.data = std::move(reply.data)};
        case UsbAnswer::Nak: return std::nullopt;
        case UsbAnswer::Stall: return Outcome{.status = -EPIPE};
        case UsbAnswer::Error: return Outcome{.status = -EPROTO};
        case UsbAnswer::Overflow: return Outcome{.status = -EOVERFLOW};
        case UsbAnswer::NoMemory: return Outcome{.status = -ENOMEM};
        case UsbAnswer::Gone: break;
    }
    return Outcome{.status = -ENODEV};
}

Result<void> UsbipLine::end(const Submit& submit, Outcome outcome) {
    int& status = outcome.status;
    usbip::Bytes& data = outcome.data;
    if (!submit.in) data.clear();  // whatever its setup says
    if (submit.in && data.size() > submit.length) {
        status = -EOVERFLOW;
        data.clear();
    }
    if (status == 0 && submit.in && submit.shortNotOk && data.size() < submit.length)
        status = -EREMOTEIO;
    const bool taken = status == 0 && !submit.in;
    const auto actual = static_cast<std::uint32_t>(taken ? submit.data.size() : data.size());
    const auto head =
        usbip::submitReply({.sequence = submit.sequence, .status = status, .actual = actual});
    data.insert(data.begin(), head.begin(), head.end());
    return send(data);
}

Result<void> UsbipLine::send(std::span<const std::uint8_t> bytes) {
    return socket_.write(bytes, kPatience, stop_) ? Result<void>() : gone();
}

}  // namespace gonio::sim
