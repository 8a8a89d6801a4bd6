#include "sim/usb_device.h"

#include <algorithm>
#include <array>
#include <utility>

namespace gonio::sim {
namespace {

// USB 2.0 and 3.2, chapter 9, and HID 1.11.
constexpr std::uint8_t kDeviceType = 1, kConfigType = 2, kStringType = 3, kQualifierType = 6,
                       kBosType = 0x0F;
constexpr std::uint8_t kHidType = 0x21, kReportType = 0x22;
constexpr std::uint8_t kGetStatus = 0, kClearFeature = 1, kSetFeature = 3, kGetDescriptor = 6,
                       kGetConfiguration = 8, kSetConfiguration = 9, kGetInterface = 10,
                       kSetInterface = 11, kSetExitLatencies = 48, kSetIsochronousDelay = 49;
constexpr std::uint8_t kGetReport = 1, kSetReport = 9, kSetIdle = 10;
constexpr std::uint8_t kInput = 1, kOutput = 2, kFeature = 3;
constexpr std::uint8_t kKind = 0x60, kStandard = 0x00, kClass = 0x20;
constexpr std::uint8_t kRecipient = 0x1F, kToInterface = 1, kToEndpoint = 2;

constexpr std::uint8_t low(std::size_t v) { return static_cast<std::uint8_t>(v & 0xFF); }
constexpr std::uint8_t high(std::size_t v) { return static_cast<std::uint8_t>(v >> 8 & 0xFF); }

std::vector<std::uint8_t> copied(std::span<const std::uint8_t> bytes) {
    return {bytes.begin(), bytes.end()};
}

UsbReply stall() { return {.answer = UsbAnswer::Stall, .data = {}}; }
UsbReply done() { return {}; }

/// No more than the host asked for.
UsbReply answer(std::span<const std::uint8_t> data, std::uint16_t length) {
    const auto part = data.first(std::min<std::size_t>(data.size(), length));
    return {.answer = UsbAnswer::Done, .data = {part.begin(), part.end()}};
}

UsbReply answerOrStall(const std::optional<std::vector<std::uint8_t>>& data, std::uint16_t length) {
    return data ? answer(*data, length) : stall();
}

}  // namespace

UsbDevice::UsbDevice(DeviceConfig config, UsbIds ids)
    : kind_(config.camera), device_(std::move(config)), ids_(ids) {
    device_.onFlush([this] {
        dropHalfSent();
        if (flushed_) flushed_();
    });
}

std::vector<std::uint8_t> UsbDevice::deviceDescriptor() const {
    return usb::deviceDescriptor(ids_, kind_);
}

std::vector<std::uint8_t> UsbDevice::configDescriptor() const {
    return usb::configDescriptor(kind_);
}

std::optional<std::vector<std::uint8_t>> UsbDevice::descriptor(const UsbSetup& setup) const {
    const auto index = low(setup.value);
    if ((setup.requestType & kRecipient) == kToInterface) {
        if (low(setup.index) != kHidInterface) return std::nullopt;
        if (high(setup.value) == kHidType) return copied(usb::hidDescriptor());
        if (high(setup.value) != kReportType) return std::nullopt;
        return copied(usb::reportDescriptor());
    }
    switch (high(setup.value)) {
        case kDeviceType: return deviceDescriptor();
        case kConfigType: return index == 0 ? std::optional(configDescriptor()) : std::nullopt;
        case kStringType: return usb::stringDescriptor(index, device_.serial());
        case kQualifierType: return usb::qualifierDescriptor(kind_);
        case kBosType: return usb::bosDescriptor(kind_);
        default: return std::nullopt;
    }
}

UsbReply UsbDevice::control(const UsbSetup& setup, std::span<const std::uint8_t> out) {
    switch (setup.requestType & kKind) {
        case kStandard: return standard(setup);
        case kClass: return hidClass(setup, out);
        default: return stall();
    }
}

UsbReply UsbDevice::standard(const UsbSetup& setup) {
    const std::uint8_t recipient = setup.requestType & kRecipient;
    const bool ofStream = low(setup.index) == kBulkIn;
    switch (setup.request) {
        case kGetStatus: {
            const bool halted = recipient == kToEndpoint && ofStream && halted_;
            return answer(std::array<std::uint8_t, 2>{halted, 0}, setup.length);
        }
        case kGetDescriptor: return answerOrStall(descriptor(setup), setup.length);
        case kGetConfiguration:
            return answer(std::array<std::uint8_t, 1>{configuration_}, setup.length);
        case kGetInterface: return answer(std::array<std::uint8_t, 1>{0}, setup.length);
        case kSetFeature:
        case kClearFeature:
            if (recipient != kToEndpoint || setup.value != 0) return done();
            if (!ofStream) return done();
            halted_ = setup.request == kSetFeature;
            dropHalfSent();
            return done();
        case kSetConfiguration:
            if (setup.value > 1) return stall();
            configuration_ = low(setup.value);
            reset();
            return done();
        case kSetInterface:
            if (setup.value != 0 || setup.index > kStreamInterface) return stall();
            if (setup.index == kStreamInterface) {
                halted_ = false;
                device_.resetStream();
            }
            return done();
        case kSetExitLatencies:
        case kSetIsochronousDelay: return kind_ == CameraKind::Usb3 ? done() : stall();
        default: return stall();
    }
}

UsbReply UsbDevice::hidClass(const UsbSetup& setup, std::span<const std::uint8_t> out) {
    if (low(setup.index) != kHidInterface) return stall();
    const std::uint8_t kind = high(setup.value);
    const std::uint8_t id = low(setup.value);
    switch (setup.request) {
        case kSetIdle: return done();
        case kGetReport: {
            const bool status = id == static_cast<std::uint8_t>(driver::ReportId::Status);
            if (kind != kFeature && !(kind == kInput && status)) return stall();
            if (kind == kFeature && status) return stall();
            const auto report = device_.getFeature(id);
            return report ? answer(*report, setup.length) : stall();
        }
        case kSetReport: {
            if (out.size() != driver::kReportBytes || out[0] != id) return stall();
            if (kind == kOutput) return interruptOut(out);
            return kind == kFeature && takeReport(out) ? done() : stall();
        }
        default: return stall();
    }
}

bool UsbDevice::takeReport(std::span<const std::uint8_t> report) {
    driver::Report copy;
    std::copy(report.begin(), report.end(), copy.begin());
    return device_.setFeature(copy);
}

UsbReply UsbDevice::interruptIn() {
    const auto report = device_.takeInput();
    if (!report) return {.answer = UsbAnswer::Nak, .data = {}};
    return answer(*report, driver::kReportBytes);
}

UsbReply UsbDevice::interruptOut(std::span<const std::uint8_t> report) {
    if (report.size() != driver::kReportBytes) return stall();
    driver::Report copy;
    std::copy(report.begin(), report.end(), copy.begin());
    device_.output(copy);
    return done();
}

UsbReply UsbDevice::bulkIn(std::size_t length) {
    if (halted_) return stall();
    if (sent_ == sending_.size() && !open_) {
        auto chunk = source_ ? source_() : device_.takeBulk();
        if (!chunk) return {.answer = UsbAnswer::Nak, .data = {}};
        sending_ = std::move(*chunk);
        sent_ = 0;
        open_ = true;
    }
    if (sent_ == 0 && sending_.size() < length) {
        open_ = false;
        return {.answer = UsbAnswer::Done, .data = std::exchange(sending_, {})};
    }
    const std::size_t part = std::min(length, sending_.size() - sent_);
    const auto begin = sending_.begin() + static_cast<std::ptrdiff_t>(sent_);
    UsbReply reply{.answer = UsbAnswer::Done,
                   .data = {begin, begin + static_cast<std::ptrdiff_t>(part)}};
    sent_ += part;
    open_ = part == length;  // full: no short packet has ended it
    return reply;
}

void UsbDevice::dropHalfSent() {
    sending_.clear();
    sent_ = 0;
    open_ = false;
}

void UsbDevice::reset(Loss loss) {
    constexpr std::uint32_t kBusReset = 1, kVbus = 3;  // PROTOCOL.md, event 14
    halted_ = false;
    dropHalfSent();
    device_.linkLost(loss == Loss::Power ? kVbus : kBusReset);
}

}  // namespace gonio::sim
