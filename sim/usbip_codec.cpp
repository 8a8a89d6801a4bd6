#include "sim/usbip_codec.h"

#include <algorithm>

namespace gonio::sim::usbip {
namespace {

constexpr std::uint16_t kListRequest = 0x8005, kListReply = 0x0005;
constexpr std::uint16_t kImportRequest = 0x8003, kImportReply = 0x0003;
constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kSubmitReply = 3, kUnlinkReply = 4;
constexpr std::uint32_t kShortNotOk = 1;
constexpr std::size_t kPathBytes = 256;
constexpr std::uint8_t kEndpoints = 16;

std::uint32_t number(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (const std::uint8_t byte : bytes.subspan(at, size)) value = value << 8 | byte;
    return value;
}
std::uint32_t u32(std::span<const std::uint8_t> bytes, std::size_t at) {
    return number(bytes, at, 4);
}
std::uint16_t u16(std::span<const std::uint8_t> bytes, std::size_t at) {
    return static_cast<std::uint16_t>(number(bytes, at, 2));
}

void put(Bytes& bytes, std::uint32_t value, std::size_t size) {
    for (std::size_t i = size; i-- > 0;)
        bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFF));
}
void put32(Bytes& bytes, std::uint32_t value) { put(bytes, value, 4); }
void put16(Bytes& bytes, std::uint16_t value) { put(bytes, value, 2); }

/// Filled with zeros; the last byte is one.
void putText(Bytes& bytes, const std::string& text, std::size_t size) {
    const std::size_t end = bytes.size() + size;
    const auto kept = static_cast<std::ptrdiff_t>(std::min(text.size(), size - 1));
    bytes.insert(bytes.end(), text.begin(), text.begin() + kept);
    bytes.resize(end);
}

Error wrong(const std::string& what) { return {ErrorKind::Device, "usbip: " + what}; }

void putRig(Bytes& bytes, const Exported& rig) {
    putText(bytes, "/sys/devices/simulated/" + rig.busId, kPathBytes);
    putText(bytes, rig.busId, kBusIdBytes);
    put32(bytes, rig.bus);
    put32(bytes, rig.number);
    put32(bytes, static_cast<std::uint32_t>(rig.speed));
    put16(bytes, rig.vendor);
    put16(bytes, rig.product);
    put16(bytes, rig.release);
    for (int i = 0; i < 3; ++i) bytes.push_back(0);  // the class is that of the interfaces
    bytes.push_back(1);                              // configuration in use
    bytes.push_back(1);                              // configurations
    bytes.push_back(static_cast<std::uint8_t>(rig.interfaces.size()));
}

void putHead(Bytes& bytes, std::uint16_t code, std::uint32_t status) {
    put16(bytes, kVersion);
    put16(bytes, code);
    put32(bytes, status);
}

std::array<std::uint8_t, kCommandBytes> reply(std::uint32_t code,
                                              std::uint32_t sequence,
                                              int status,
                                              std::uint32_t actual) {
    Bytes bytes;
    put32(bytes, code);
    put32(bytes, sequence);
    bytes.resize(20);  // device, direction and endpoint are the client's own knowledge
    put32(bytes, static_cast<std::uint32_t>(status));
    put32(bytes, actual);
    std::array<std::uint8_t, kCommandBytes> whole{};
    std::copy(bytes.begin(), bytes.end(), whole.begin());
    return whole;
}

Result<std::optional<ReadCommand>> readSubmit(std::span<const std::uint8_t> bytes) {
    Submit submit{.sequence = u32(bytes, 4),
                  .in = u32(bytes, 12) == 1,
                  .shortNotOk = (u32(bytes, 20) & kShortNotOk) != 0,
                  .length = u32(bytes, 24)};
    if (u32(bytes, 12) > 1) return wrong("a transfer in neither direction");
    const std::uint32_t endpoint = u32(bytes, 16);
    if (endpoint >= kEndpoints) return wrong("endpoint " + std::to_string(endpoint));
    submit.endpoint = static_cast<std::uint8_t>(endpoint);
    // Isochronous transfers only: none of a rig's endpoints is.
    const std::uint32_t packets = u32(bytes, 32);
    if (packets != 0 && packets != 0xFFFFFFFF) return wrong("an isochronous transfer");
    const std::uint32_t most = submit.in ? kMostIn : kMostOut;
    if (submit.length > most) {
        return wrong("a transfer of " + std::to_string(submit.length) + " bytes, at most " +
                     std::to_string(most) + " are served");
    }
    std::copy_n(bytes.begin() + 40, submit.setup.size(), submit.setup.begin());
    const std::size_t whole = kCommandBytes + (submit.in ? 0 : submit.length);
    if (bytes.size() < whole) return std::optional<ReadCommand>();
    const auto data = bytes.subspan(kCommandBytes, whole - kCommandBytes);
    submit.data.assign(data.begin(), data.end());
    return std::optional(ReadCommand{{.submit = std::move(submit)}, whole});
}

}  // namespace

Result<std::optional<ReadRequest>> readRequest(std::span<const std::uint8_t> bytes) {
    const std::optional<ReadRequest> more;
    if (bytes.size() < kRequestBytes) return more;
    if (u16(bytes, 0) != kVersion) return wrong("a version that is not 1.1.1");
    const std::uint16_t code = u16(bytes, 2);
    if (code == kListRequest)
        return std::optional(ReadRequest{{.kind = Request::Kind::List}, kRequestBytes});
    if (code != kImportRequest) return wrong("an unknown request");
    constexpr std::size_t kWhole = kRequestBytes + kBusIdBytes;
    if (bytes.size() < kWhole) return more;
    const auto id = bytes.subspan(kRequestBytes, kBusIdBytes);
    const auto end = std::find(id.begin(), id.end(), 0);
    return std::optional(
        ReadRequest{{.kind = Request::Kind::Import, .busId = {id.begin(), end}}, kWhole});
}

Result<std::optional<ReadCommand>> readCommand(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < kCommandBytes) return std::optional<ReadCommand>();
    switch (u32(bytes, 0)) {
        case kSubmit: return readSubmit(bytes);
        case kUnlink: {
            const Unlink unlink{.sequence = u32(bytes, 4), .victim = u32(bytes, 20)};
            return std::optional(ReadCommand{{.unlink = unlink}, kCommandBytes});
        }
        default: return wrong("an unknown command");
    }
}

Bytes listReply(std::span<const Exported> rigs) {
    Bytes bytes;
    putHead(bytes, kListReply, 0);
    put32(bytes, static_cast<std::uint32_t>(rigs.size()));
    for (const Exported& rig : rigs) {
        putRig(bytes, rig);
        for (const InterfaceClass& interface : rig.interfaces)
            bytes.insert(bytes.end(),
                         {interface.ofClass, interface.subclass, interface.protocol, 0});
    }
    return bytes;
}

Bytes importReply(ImportStatus status, const Exported& rig) {
    Bytes bytes;
    putHead(bytes, kImportReply, static_cast<std::uint32_t>(status));
    if (status == ImportStatus::Ok) putRig(bytes, rig);
    return bytes;
}

std::array<std::uint8_t, kCommandBytes> submitReply(const Ended& ended) {
    return reply(kSubmitReply, ended.sequence, ended.status, ended.actual);
}

std::array<std::uint8_t, kCommandBytes> unlinkReply(std::uint32_t sequence, int status) {
    return reply(kUnlinkReply, sequence, status, 0);
}

}  // namespace gonio::sim::usbip
