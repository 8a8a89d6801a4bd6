#include "sim/usb_descriptors.h"

#include <array>

#include "driver/protocol/constants.h"

namespace gonio::sim::usb {
namespace {

// USB 2.0 and 3.2, chapter 9, and HID 1.11.
constexpr std::uint8_t kDevice = 1, kConfig = 2, kString = 3, kInterface = 4, kEndpoint = 5,
                       kQualifier = 6, kBos = 0x0F, kCapability = 0x10, kCompanion = 0x30;
constexpr std::uint8_t kHid = 0x21, kReport = 0x22;
constexpr std::uint8_t kBulk = 2, kInterrupt = 3;
constexpr std::uint8_t kProtocolString = 240;
constexpr std::uint8_t kReportBytes = 64;
constexpr std::uint8_t kEvery4ms = 6;  // 2^(6-1) microframes, at both speeds
constexpr std::uint8_t kBurst = 15;    // sixteen packets at a time

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
    9, kHid, 0x11, 0x01, 0, 1, kReport, low(kReportDescriptor.size()), 0};

void add(Bytes& all, std::span<const std::uint8_t> part) {
    all.insert(all.end(), part.begin(), part.end());
}

void addInterruptEndpoint(Bytes& all, std::uint8_t address, CameraKind kind) {
    add(all,
        std::array<std::uint8_t, 7>{7, kEndpoint, address, kInterrupt, kReportBytes, 0, kEvery4ms});
    if (kind != CameraKind::Usb3) return;
    add(all, std::array<std::uint8_t, 6>{6, kCompanion, 0, 0, kReportBytes, 0});
}

void addBulkEndpoint(Bytes& all, std::uint8_t address, CameraKind kind) {
    const std::size_t packet = cameraLink(kind).bulkPacket;
    add(all,
        std::array<std::uint8_t, 7>{7, kEndpoint, address, kBulk, low(packet), high(packet), 0});
    if (kind != CameraKind::Usb3) return;
    add(all, std::array<std::uint8_t, 6>{6, kCompanion, kBurst, 0, 0, 0});
}

/// An interface of two endpoints or one, alternate setting 0 alone.
void addInterface(Bytes& all,
                  std::uint8_t number,
                  std::uint8_t endpoints,
                  const std::array<std::uint8_t, 3>& classes) {
    add(all,
        std::array<std::uint8_t, 9>{
            9, kInterface, number, 0, endpoints, classes[0], classes[1], classes[2], 0});
}

}  // namespace

std::span<const std::uint8_t> reportDescriptor() { return kReportDescriptor; }
std::span<const std::uint8_t> hidDescriptor() { return kHidDescriptor; }

Bytes deviceDescriptor(const UsbIds& ids, CameraKind kind) {
    const bool super = kind == CameraKind::Usb3;
    return {18,
            kDevice,
            0x00,
            super ? std::uint8_t{3} : std::uint8_t{2},  // USB 3.0 or 2.0
            0,
            0,
            0,  // class: per interface
            // Bytes in a packet of endpoint 0; at SuperSpeed their power of two, 512.
            super ? std::uint8_t{9} : std::uint8_t{64},
            low(ids.vendor),
            high(ids.vendor),
            low(ids.product),
            high(ids.product),
            0x00,
            0x01,  // device release 1.0
            1,
            2,
            3,  // strings: maker, product, serial number
            1};
}

Bytes configDescriptor(CameraKind kind) {
    // Bus powered, 500 mA; the unit is 2 mA, at SuperSpeed 8 mA.
    const std::uint8_t power = kind == CameraKind::Usb3 ? 62 : 250;
    Bytes all{9, kConfig, 0, 0, 2, 1, 0, 0x80, power};
    addInterface(all, kHidInterface, 2, {3, 0, 0});
    add(all, kHidDescriptor);
    addInterruptEndpoint(all, kInterruptIn, kind);
    addInterruptEndpoint(all, kInterruptOut, kind);
    addInterface(all, kStreamInterface, 1, {0xFF, 0x47, 0x01});
    addBulkEndpoint(all, kBulkIn, kind);
    all[2] = low(all.size());
    all[3] = high(all.size());
    return all;
}

std::optional<Bytes> bosDescriptor(CameraKind kind) {
    if (kind != CameraKind::Usb3) return std::nullopt;
    constexpr std::uint8_t kUsb2Extension = 2, kSuperSpeed = 3;
    constexpr std::uint8_t kPowerStates = 0b10;  // LPM, which USB 3 wants at 2.0 too
    constexpr std::uint8_t kHighAndSuper = 0b1100, kFullAt = 3;  // speeds; all works at this one
    constexpr std::uint8_t kU1Exit = 10;                         // us
    constexpr std::uint16_t kU2Exit = 511;                       // us
    Bytes all{5, kBos, 0, 0, 2};
    add(all, std::array<std::uint8_t, 7>{7, kCapability, kUsb2Extension, kPowerStates, 0, 0, 0});
    add(all,
        std::array<std::uint8_t, 10>{10,
                                     kCapability,
                                     kSuperSpeed,
                                     0,
                                     kHighAndSuper,
                                     0,
                                     kFullAt,
                                     kU1Exit,
                                     low(kU2Exit),
                                     high(kU2Exit)});
    all[2] = low(all.size());
    all[3] = high(all.size());
    return all;
}

std::optional<Bytes> qualifierDescriptor(CameraKind kind) {
    if (kind != CameraKind::Usb2) return std::nullopt;
    return Bytes{10, kQualifier, 0x00, 0x02, 0, 0, 0, 64, 1, 0};
}

std::optional<Bytes> stringDescriptor(std::uint8_t index, const std::string& serial) {
    if (index == 0) return Bytes{4, kString, 0x09, 0x04};  // English
    std::string text;
    switch (index) {
        case 1: text = "gonio"; break;
        case 2: text = "simulated rig"; break;
        case 3: text = serial; break;
        case kProtocolString:
            text = "GRP/" + std::to_string(driver::kProtocolMajor) + "." +
                   std::to_string(driver::kProtocolMinor);
            break;
        default: return std::nullopt;
    }
    Bytes bytes{low(2 + 2 * text.size()), kString};
    for (char c : text) {
        bytes.push_back(static_cast<std::uint8_t>(c));
        bytes.push_back(0);
    }
    return bytes;
}

}  // namespace gonio::sim::usb
