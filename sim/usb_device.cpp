#include "sim/usb_device.h"

#include <algorithm>
#include <array>
#include <string>

namespace gonio::sim {
namespace {

// USB 2.0, chapter 9, and HID 1.11.
constexpr std::uint8_t kDeviceType = 1, kConfigType = 2, kStringType = 3, kQualifierType = 6;
constexpr std::uint8_t kHidType = 0x21, kReportType = 0x22;
constexpr std::uint8_t kGetStatus = 0, kClearFeature = 1, kSetFeature = 3, kGetDescriptor = 6,
                       kGetConfiguration = 8, kSetConfiguration = 9, kGetInterface = 10,
                       kSetInterface = 11;
constexpr std::uint8_t kGetReport = 1, kSetReport = 9, kSetIdle = 10;
constexpr std::uint8_t kInput = 1, kOutput = 2, kFeature = 3;
constexpr std::uint8_t kToHost = 0x80, kKind = 0x60, kStandard = 0x00, kClass = 0x20;
constexpr std::uint8_t kRecipient = 0x1F, kToInterface = 1, kToEndpoint = 2;
constexpr std::uint8_t kProtocolString = 240;

constexpr std::uint8_t low(std::size_t v) { return static_cast<std::uint8_t>(v & 0xFF); }
constexpr std::uint8_t high(std::size_t v) { return static_cast<std::uint8_t>(v >> 8 & 0xFF); }

/// PROTOCOL.md 1: numbered reports of 63 bytes.
constexpr std::array<std::uint8_t, 77> kReportDescriptor{
    0x06, 0x47, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x3F,
    0x85, 0x01, 0x09, 0x01, 0xB1, 0x02, 0x85, 0x02, 0x09, 0x02, 0xB1, 0x02, 0x85, 0x03, 0x09, 0x03,
    0xB1, 0x02, 0x85, 0x04, 0x09, 0x04, 0xB1, 0x02, 0x85, 0x05, 0x09, 0x05, 0xB1, 0x02, 0x85, 0x06,
    0x09, 0x06, 0xB1, 0x02, 0x85, 0x10, 0x09, 0x10, 0x81, 0x02, 0x85, 0x11, 0x09, 0x11, 0x81, 0x02,
    0x85, 0x21, 0x09, 0x21, 0x81, 0x02, 0x85, 0x20, 0x09, 0x20, 0x91, 0x02, 0xC0};

constexpr std::array<std::uint8_t, 9> kHidDescriptor{
    9, kHidType, 0x11, 0x01, 0, 1, kReportType, low(kReportDescriptor.size()), 0};

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

UsbDevice::UsbDevice(DeviceConfig config, UsbIds ids) : device_(std::move(config)), ids_(ids) {}

std::span<const std::uint8_t> UsbDevice::reportDescriptor() { return kReportDescriptor; }

std::vector<std::uint8_t> UsbDevice::deviceDescriptor() const {
    return {18,
            kDeviceType,
            0x00,
            0x02,  // USB 2.0
            0,
            0,
            0,   // class: per interface
            64,  // bytes in a packet of endpoint 0
            low(ids_.vendor),
            high(ids_.vendor),
            low(ids_.product),
            high(ids_.product),
            0x00,
            0x01,  // device release 1.0
            1,
            2,
            3,  // strings: maker, product, serial number
            1};
}

std::vector<std::uint8_t> UsbDevice::configDescriptor() const {
    std::vector<std::uint8_t> all{9, kConfigType, 0, 0, 2, 1, 0, 0x80, 250};  // bus powered, 500 mA
    const auto add = [&all](std::span<const std::uint8_t> part) {
        all.insert(all.end(), part.begin(), part.end());
    };
    add(std::array<std::uint8_t, 9>{9, 4, kHidInterface, 0, 2, 3, 0, 0, 0});
    add(kHidDescriptor);
    add(std::array<std::uint8_t, 7>{7, 5, kInterruptIn, 3, 64, 0, 6});  // every 4 ms
    add(std::array<std::uint8_t, 7>{7, 5, kInterruptOut, 3, 64, 0, 6});
    add(std::array<std::uint8_t, 9>{9, 4, kStreamInterface, 0, 1, 0xFF, 0x47, 0x01, 0});
    add(std::array<std::uint8_t, 7>{7, 5, kBulkIn, 2, low(kBulkPacket), high(kBulkPacket), 0});
    all[2] = low(all.size());
    all[3] = high(all.size());
    return all;
}

std::optional<std::vector<std::uint8_t>> UsbDevice::string(std::uint8_t index) const {
    if (index == 0) return std::vector<std::uint8_t>{4, kStringType, 0x09, 0x04};  // English
    std::string text;
    switch (index) {
        case 1: text = "gonio"; break;
        case 2: text = "simulated rig"; break;
        case 3: text = device_.serial(); break;
        case kProtocolString:
            text = "GRP/" + std::to_string(driver::kProtocolMajor) + "." +
                   std::to_string(driver::kProtocolMinor);
            break;
        default: return std::nullopt;
    }
    std::vector<std::uint8_t> bytes{low(2 + 2 * text.size()), kStringType};
    for (char c : text) {
        bytes.push_back(static_cast<std::uint8_t>(c));
        bytes.push_back(0);
    }
    return bytes;
}

std::optional<std::vector<std::uint8_t>> UsbDevice::descriptor(const UsbSetup& setup) const {
    const auto index = low(setup.value);
    if ((setup.requestType & kRecipient) == kToInterface) {
        if (low(setup.index) != kHidInterface) return std::nullopt;
        if (high(setup.value) == kHidType)
            return std::vector<std::uint8_t>(kHidDescriptor.begin(), kHidDescriptor.end());
        if (high(setup.value) != kReportType) return std::nullopt;
        return std::vector<std::uint8_t>(kReportDescriptor.begin(), kReportDescriptor.end());
    }
    switch (high(setup.value)) {
        case kDeviceType: return deviceDescriptor();
        case kConfigType: return index == 0 ? std::optional(configDescriptor()) : std::nullopt;
        case kStringType: return string(index);
        case kQualifierType:
            return std::vector<std::uint8_t>{10, kQualifierType, 0x00, 0x02, 0, 0, 0, 64, 1, 0};
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
                dropHalfSent();
                device_.resetStream();
            }
            return done();
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
        auto chunk = device_.takeBulk();
        if (!chunk) return {.answer = UsbAnswer::Nak, .data = {}};
        sending_ = std::move(*chunk);
        sent_ = 0;
        open_ = true;
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

void UsbDevice::reset() {
    halted_ = false;
    dropHalfSent();
    device_.linkLost();
}

}  // namespace gonio::sim
