#include "sim/in_process.h"

#include <algorithm>
#include <string>
#include <utility>

#include "proc/core/log.h"
#include "sim/frame_chunks.h"

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kControlTime = 200us;
constexpr Nanoseconds kRequestLimit = 1s;  // as driver/hid_channel.h
constexpr Nanoseconds kResetTime = 100ms;  // of a port
constexpr int kFewestTransfers = 2;

// Requests: USB 2.0, chapter 9, and HID 1.11.
constexpr UsbSetup kGetStatus{.requestType = 0x80, .request = 0, .length = 2};
constexpr UsbSetup kClearHalt{.requestType = 0x02, .request = 1, .index = usb::kBulkIn};
constexpr UsbSetup kClearReports{.requestType = 0x02, .request = 1, .index = usb::kInterruptIn};

UsbSetup featureRequest(bool get, std::uint8_t id) {
    constexpr std::uint16_t kFeature = 3 << 8;
    return {.requestType = static_cast<std::uint8_t>(get ? 0xA1 : 0x21),
            .request = static_cast<std::uint8_t>(get ? 1 : 9),
            .value = static_cast<std::uint16_t>(kFeature | id),
            .index = UsbDevice::kHidInterface,
            .length = driver::kReportBytes};
}

std::string feature(int id) { return "feature report " + std::to_string(id); }

/// A chunk rounded up to packets, and one packet: what ends it never stands alone.
std::size_t transferBytes(std::size_t maxPayload, std::size_t packet) {
    const std::size_t chunk = driver::kChunkHeaderBytes + maxPayload;
    return ((chunk + packet - 1) / packet + 1) * packet;
}

}  // namespace

InProcessDoor::InProcessDoor(DeviceConfig config)
    : InProcessDoor(std::make_shared<FaultyUsb>(std::move(config)), 0) {}

InProcessDoor::InProcessDoor(std::shared_ptr<FaultyUsb> usb, int pulls)
    : usb_(std::move(usb)), pulls_(pulls) {
    constexpr std::uint8_t kSerialString = 3, kProtocolString = 240;
    usb_->reportsOpened();
    strings_ = {.vendor = usb_->ids().vendor,
                .product = usb_->ids().product,
                .serial = stringOf(kSerialString),
                .protocol = stringOf(kProtocolString)};
}

Result<std::unique_ptr<InProcessDoor>> InProcessDoor::openAgain() const {
    if (!usb_->plugged()) return Error{ErrorKind::NoRig, "no rig is plugged in"};
    std::unique_ptr<InProcessDoor> door(new InProcessDoor(usb_, usb_->pulls()));
    (void)door->fillRing();
    if (!door->starvedSince_) return door;
    return Error{ErrorKind::Device, driver::memoryHint("rig " + door->strings_.serial, 0)};
}

std::string InProcessDoor::stringOf(std::uint8_t index) {
    constexpr std::uint16_t kStringType = 3 << 8;
    const UsbReply reply = usb_->control({.requestType = 0x80,
                                          .request = 6,
                                          .value = static_cast<std::uint16_t>(kStringType | index),
                                          .length = 255});
    // As the real door reads it (textIn in driver/usb_find.h).
    const auto& raw = reply.data;
    if (raw.size() < 2 || raw[0] < 2 || raw[1] != kStringType >> 8) return {};
    std::string text;
    for (std::size_t i = 2; i + 1 < std::min<std::size_t>(raw[0], raw.size()); i += 2) {
        const bool printable = raw[i + 1] == 0 && raw[i] >= ' ' && raw[i] <= '~';
        text += printable ? static_cast<char>(raw[i]) : ' ';
    }
    return text;
}

// ---- time and failure

bool InProcessDoor::pass(Nanoseconds deadline) {
    if (now() >= deadline) return false;
    // At least one step, so that an event at this very moment is passed.
    const Nanoseconds next = std::max(usb_->nextEvent(), now() + 1ns);
    usb_->advanceTo(std::min(next, deadline));
    return true;
}

Error InProcessDoor::fail(const std::string& what) {
    if (!failure_) failure_ = Error{ErrorKind::Device, "rig " + strings_.serial + " " + what};
    return *failure_;
}

Result<void> InProcessDoor::there() {
    if (failure_) return *failure_;
    if (usb_->pulls() == pulls_) return {};
    return fail("is gone; check its cable and power");
}

template <class Ask>
Result<UsbReply> InProcessDoor::request(const std::string& what, Ask ask) {
    spend(kControlTime);
    const Nanoseconds deadline = now() + kRequestLimit;
    while (true) {
        if (auto is = there(); !is) return is.error();
        UsbReply reply = ask();
        if (reply.answer == UsbAnswer::Stall)
            return Error{ErrorKind::Device, what + ": the device stalled"};
        if (reply.answer == UsbAnswer::Done) return reply;
        if (reply.answer == UsbAnswer::Gone) continue;  // there() says so
        if (!pass(deadline)) return fail("does not answer; check its cable and power");
    }
}

// ---- reports

Result<void> InProcessDoor::write(const driver::Report& report) {
    const auto done = request("command", [&] { return usb_->interruptOut(report); });
    if (!done) return done.error();
    return {};
}

Result<void> InProcessDoor::setFeature(const driver::Report& report) {
    const auto done = request(feature(report[0]), [&] {
        return usb_->control(featureRequest(false, report[0]), report);
    });
    if (!done) return done.error();
    return {};
}

Result<driver::Report> InProcessDoor::getFeature(std::uint8_t id) {
    const auto reply =
        request(feature(id), [&] { return usb_->control(featureRequest(true, id)); });
    if (!reply) return reply.error();
    driver::Report report{};
    if (reply->data.size() != report.size()) {
        return Error{ErrorKind::Device,
                     feature(id) + ": " + std::to_string(reply->data.size()) + " bytes, wanted " +
                         std::to_string(report.size())};
    }
    std::copy(reply->data.begin(), reply->data.end(), report.begin());
    return report;
}

Result<std::optional<driver::Report>> InProcessDoor::readInput(Nanoseconds wait) {
    const Nanoseconds deadline = now() + wait;
    do {
        if (auto is = there(); !is) return is.error();
        const UsbReply reply = usb_->interruptIn();
        // The kernel's part: usbhid clears the halt of its endpoint by itself.
        if (reply.answer == UsbAnswer::Stall) (void)usb_->control(kClearReports);
        if (reply.answer != UsbAnswer::Done) continue;
        driver::Report report{};
        std::copy_n(reply.data.begin(), std::min(report.size(), reply.data.size()), report.begin());
        return std::optional(report);
    } while (pass(deadline));
    return std::optional<driver::Report>{};
}

Result<void> InProcessDoor::reopenReports() {
    spend(kControlTime);
    if (auto is = there(); !is) return is;
    usb_->reportsOpened();
    while (usb_->interruptIn().answer == UsbAnswer::Done) {
    }
    return {};
}

// ---- the stream

Result<std::optional<driver::BulkBytes>> InProcessDoor::readBulk(Nanoseconds wait) {
    const Nanoseconds deadline = now() + wait;
    const std::size_t room = transferBytes(device().maxChunkPayload(), usb_->bulkPacket());
    do {
        if (failure_) return *failure_;
        if (auto filled = fillRing(); !filled) return filled.error();
        if (counters_.inFlight == 0) continue;  // nothing that the rig could answer
        UsbReply reply = usb_->bulkIn(room);
        if (reply.answer != UsbAnswer::Nak) --counters_.inFlight;
        if (reply.answer == UsbAnswer::Done) {
            lent_ = std::move(reply.data);
            const double cost =
                device().link().nanosecondsPerByte * static_cast<double>(lent_.size());
            spend(Nanoseconds(static_cast<std::int64_t>(cost)));
            return std::optional<driver::BulkBytes>(lent_);
        }
        if (reply.answer == UsbAnswer::Nak) {
            if (auto is = there(); !is) return is.error();
        } else if (auto goesOn = recover(reply.answer); !goesOn) {
            return goesOn.error();
        }
    } while (pass(deadline));
    return std::optional<driver::BulkBytes>{};
}

/// PROTOCOL.md 4: one control request decides whether it is there; then a stall is cleared.
Result<void> InProcessDoor::recover(UsbAnswer answer) {
    if (answer == UsbAnswer::Overflow) {
        ++counters_.overflows;
        return {};
    }
    const bool stalled = answer == UsbAnswer::Stall;
    auto decided = request("probe", [&] { return usb_->control(kGetStatus); });
    if (decided && stalled)
        decided = request("clear halt", [&] { return usb_->control(kClearHalt); });
    if (!decided) return decided.error();
    ++(stalled ? counters_.stalls : counters_.errors);
    if (limit_.third(now())) {
        failure_ = driver::streamFault("rig " + strings_.serial);
        return *failure_;
    }
    return {};
}

/// Submits what may be in flight. No memory for as many: half of them, two at least.
Result<void> InProcessDoor::fillRing() {
    while (counters_.inFlight < counters_.ring) {
        if (counters_.inFlight < usb_->mostTransfers()) {
            ++counters_.inFlight;
            starvedSince_.reset();
            continue;
        }
        counters_.ring = std::max(kFewestTransfers, counters_.ring / 2);
        const std::string name = "rig " + strings_.serial;
        if (!std::exchange(warned_, true)) log::warning(driver::memoryHint(name, counters_.ring));
        if (counters_.inFlight > 0) return {};
        if (!starvedSince_) starvedSince_ = now();
        if (now() - *starvedSince_ < driver::kMemoryLimit) return {};
        failure_ = Error{ErrorKind::Device, driver::memoryHint(name, 0)};
        return *failure_;
    }
    return {};
}

Result<void> InProcessDoor::resetPort() {
    spend(kResetTime);
    if (usb_->pulls() != pulls_) return there();
    usb_->resetPort();
    failure_ = Error{ErrorKind::Device, "rig " + strings_.serial + ": its port was reset"};
    return {};
}

}  // namespace gonio::sim
