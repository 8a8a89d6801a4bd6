#include "sim/faults/spoiled_answers.h"

#include <algorithm>
#include <array>

#include "driver/protocol/crc.h"
#include "driver/protocol/wire.h"

namespace gonio::sim {
namespace {

constexpr std::uint8_t kGetDescriptor = 6, kGetReport = 1, kStringType = 3;
constexpr std::uint8_t kIdent = 1, kLimits = 6;
constexpr std::uint8_t kSerialString = 3, kProtocolString = 240;
constexpr std::size_t kCrcAt = driver::kReportBytes - 2;

/// A field that is overwritten; its report's CRC is sound again afterwards.
struct Field {
    std::string_view name;
    std::uint8_t report;
    std::size_t offset, bytes;
    std::uint32_t value;
};
constexpr std::array kFields{
    Field{"led-count-none", kIdent, 21, 1, 0},
    Field{"led-count-many", kIdent, 21, 1, 200},
    Field{"sensor-none", kIdent, 16, 2, 0},
    Field{"bit-depth", kIdent, 20, 1, 77},
    Field{"chunk-none", kIdent, 44, 4, 0},
    Field{"chunk-huge", kIdent, 44, 4, 0xFFFFFFFF},
    Field{"latency-none", kIdent, 60, 1, 0},
    Field{"exposure-range", kIdent, 50, 4, 0xFFFFFFFF},
    Field{"frames-none", kLimits, 4, 2, 0},
    Field{"roi-none", kLimits, 3, 1, 0},
    Field{"period-endless", kLimits, 6, 4, 0xFFFFFFFF},
    Field{"scale-none", kLimits, 14, 2, 0},
};

/// A string descriptor's text instead of the rig's own.
struct Text {
    std::string_view name;
    std::uint8_t index;
    std::string_view text;
};
constexpr std::array kTexts{
    Text{"serial-empty", kSerialString, ""},
    Text{"serial-long", kSerialString, "SIM-0123456789-0123456789-0123456789-0123456789"},
    Text{"serial-hostile", kSerialString, "SIM\x1b[2J\n%s%n"},
    Text{"protocol-text", kProtocolString, "GRP/banana"},
    Text{"protocol-none", kProtocolString, ""},
};

/// A string descriptor's own bytes.
struct RawText {
    std::string_view name;
    std::array<std::uint8_t, 5> bytes;
};
constexpr std::array kRawTexts{
    RawText{"string-short", {1, kStringType, 'S', 0, 'I'}},
    RawText{"string-type", {5, 4, 'S', 0, 'I'}},
    RawText{"string-long", {255, kStringType, 0xFF, 0xD8, 'I'}},  // half a pair, and half a letter
};

constexpr std::uint8_t kInterfaceType = 4, kEndpointType = 5;
constexpr std::uint8_t kNoMatter = 0xFF;

/// A byte of the configuration that is overwritten: of the first descriptor of this type whose
/// third byte (number of an interface, address of an endpoint) is so.
struct ConfigByte {
    std::string_view name;
    std::uint8_t type, third;
    std::size_t offset;
    std::uint8_t value;
};
constexpr std::array kConfigBytes{
    ConfigByte{"config-interfaces", 2, kNoMatter, 4, 200},
    ConfigByte{"hid-class", kInterfaceType, usb::kHidInterface, 5, 0xFF},
    ConfigByte{"stream-class", kInterfaceType, usb::kStreamInterface, 5, 8},
    ConfigByte{"stream-protocol", kInterfaceType, usb::kStreamInterface, 7, 9},
    ConfigByte{"stream-length-none", kInterfaceType, usb::kStreamInterface, 0, 0},
    ConfigByte{"stream-length-long", kInterfaceType, usb::kStreamInterface, 0, 255},
    ConfigByte{"endpoints-many", kInterfaceType, usb::kStreamInterface, 4, 31},
    ConfigByte{"endpoint-direction", kEndpointType, usb::kBulkIn, 2, 0x02},
    ConfigByte{"endpoint-kind", kEndpointType, usb::kBulkIn, 3, 3},
    ConfigByte{"endpoint-packet", kEndpointType, usb::kBulkIn, 5, 0},
    ConfigByte{"endpoint-length", kEndpointType, usb::kBulkIn, 0, 2},
};
constexpr std::string_view kEndpointNone = "endpoint-none", kConfigTotal = "config-total",
                           kNoSerial = "serial-index-none";
constexpr std::array kDescriptors{kEndpointNone, kConfigTotal, kNoSerial};

constexpr std::string_view kIdentCrc = "ident-crc", kIdentShort = "ident-short";

void sealReport(std::vector<std::uint8_t>& report) {
    driver::put<std::uint16_t>(report, kCrcAt, driver::crc16(std::span(report).first(kCrcAt)));
}

void setText(UsbReply& reply, std::string_view text) {
    reply.data = {static_cast<std::uint8_t>(2 + 2 * text.size()), kStringType};
    for (const char c : text) {
        reply.data.push_back(static_cast<std::uint8_t>(c));
        reply.data.push_back(0);
    }
}

/// Where the answer is that long: another malformation may have shortened it.
void setByte(std::vector<std::uint8_t>& answer, std::size_t at, std::uint8_t value) {
    if (at < answer.size()) answer[at] = value;
}

/// Where such a descriptor begins; the end where there is none.
std::size_t placeOf(const std::vector<std::uint8_t>& all, std::uint8_t type, std::uint8_t third) {
    std::size_t at = 0;
    while (at + 2 < all.size() && all[at] > 0) {
        if (all[at + 1] == type && (third == kNoMatter || all[at + 2] == third)) return at;
        at += all[at];
    }
    return all.size();
}

void malform(std::string_view name, std::uint8_t report, UsbReply& reply) {
    for (const Field& field : kFields) {
        if (field.name != name || field.report != report) continue;
        for (std::size_t i = 0; i < field.bytes; ++i)
            reply.data[field.offset + i] = static_cast<std::uint8_t>(field.value >> (8 * i));
        sealReport(reply.data);
    }
    if (report != kIdent) return;
    if (name == kIdentCrc) reply.data[kCrcAt] ^= 1;
    if (name == kIdentShort) reply.data.resize(10);
}

}  // namespace

std::string malformations() {
    std::string list{kIdentCrc};
    list += ", " + std::string(kIdentShort);
    for (const Field& field : kFields) list += ", " + std::string(field.name);
    for (const Text& text : kTexts) list += ", " + std::string(text.name);
    for (const RawText& text : kRawTexts) list += ", " + std::string(text.name);
    for (const ConfigByte& byte : kConfigBytes) list += ", " + std::string(byte.name);
    for (const std::string_view name : kDescriptors) list += ", " + std::string(name);
    return list;
}

bool isMalformation(std::string_view name) {
    const auto named = [&](const auto& entry) { return entry.name == name; };
    return name == kIdentCrc || name == kIdentShort ||
           std::any_of(kFields.begin(), kFields.end(), named) ||
           std::any_of(kTexts.begin(), kTexts.end(), named) ||
           std::any_of(kRawTexts.begin(), kRawTexts.end(), named) || malformsDescriptors(name);
}

bool malformsDescriptors(std::string_view name) {
    return std::find(kDescriptors.begin(), kDescriptors.end(), name) != kDescriptors.end() ||
           std::any_of(kConfigBytes.begin(), kConfigBytes.end(), [&](const ConfigByte& byte) {
               return byte.name == name;
           });
}

void SpoiledAnswers::spoilDevice(std::vector<std::uint8_t>& descriptor) const {
    constexpr std::size_t kSerialIndex = 16;
    if (std::find(malformed_.begin(), malformed_.end(), kNoSerial) != malformed_.end())
        descriptor[kSerialIndex] = 0;
}

void SpoiledAnswers::spoilConfig(std::vector<std::uint8_t>& descriptors) const {
    constexpr std::size_t kTotal = 2, kEndpoints = 4;
    for (const std::string& name : malformed_) {
        if (name == kConfigTotal) descriptors[kTotal] = descriptors[kTotal + 1] = 0xFF;
        if (name == kEndpointNone) {
            const auto interface = placeOf(descriptors, kInterfaceType, usb::kStreamInterface);
            setByte(descriptors, interface + kEndpoints, 0);
            descriptors.resize(placeOf(descriptors, kEndpointType, usb::kBulkIn));
            descriptors[kTotal] = static_cast<std::uint8_t>(descriptors.size());
            descriptors[kTotal + 1] = static_cast<std::uint8_t>(descriptors.size() >> 8);
        }
        for (const ConfigByte& byte : kConfigBytes) {
            if (byte.name != name) continue;
            const std::size_t there = placeOf(descriptors, byte.type, byte.third);
            if (there < descriptors.size()) setByte(descriptors, there + byte.offset, byte.value);
        }
    }
}

bool SpoiledAnswers::put(const DueFault& fault) {
    switch (fault.kind) {
        case FaultKind::NewerMinor: ++minor_; return true;
        case FaultKind::NewerMajor: ++major_; return true;
        case FaultKind::Malform:
            if (std::ranges::find(malformed_, fault.name) == malformed_.end())
                malformed_.push_back(fault.name);
            return true;
        default: return false;
    }
}

void SpoiledAnswers::spoil(const UsbSetup& setup, UsbReply& reply) const {
    if (reply.answer != UsbAnswer::Done) return;
    const auto low = static_cast<std::uint8_t>(setup.value & 0xFF);
    const auto high = static_cast<std::uint8_t>(setup.value >> 8);
    if (setup.requestType == 0xA1 && setup.request == kGetReport &&
        reply.data.size() == driver::kReportBytes) {
        if (low == kIdent && (major_ != 1 || minor_ != 0)) {
            reply.data[1] = static_cast<std::uint8_t>(major_);
            reply.data[2] = static_cast<std::uint8_t>(minor_);
            sealReport(reply.data);
        }
        for (const std::string& name : malformed_) {
            if (reply.data.size() == driver::kReportBytes) malform(name, low, reply);
        }
    }
    if (setup.requestType != 0x80 || setup.request != kGetDescriptor || high != kStringType) return;
    for (const RawText& text : kRawTexts) {
        const bool wanted =
            std::find(malformed_.begin(), malformed_.end(), text.name) != malformed_.end();
        if (wanted && low == kSerialString) reply.data = {text.bytes.begin(), text.bytes.end()};
    }
    if (low == kProtocolString && (major_ != 1 || minor_ != 0))
        setText(reply, "GRP/" + std::to_string(major_) + "." + std::to_string(minor_));
    for (const Text& text : kTexts) {
        const bool wanted =
            std::find(malformed_.begin(), malformed_.end(), text.name) != malformed_.end();
        if (wanted && text.index == low) setText(reply, text.text);
    }
    if (reply.data.size() > setup.length) reply.data.resize(setup.length);
}

}  // namespace gonio::sim
