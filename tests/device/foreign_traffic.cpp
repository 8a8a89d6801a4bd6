#include "tests/device/foreign_traffic.h"

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "driver/protocol/wire.h"

namespace gonio::device_test {
namespace {

constexpr int kBulk = 3;  // of usbmon's transfer types, and of usbfs' URB types
constexpr int kIn = 0x80;

ForeignTraffic readPackets(const std::vector<std::uint8_t>& file) {
    constexpr std::uint32_t kPacketBlock = 6;
    constexpr std::size_t kPacketHead = 28, kUsbmonHead = 64;
    ForeignTraffic traffic;
    const std::span<const std::uint8_t> bytes(file);
    for (std::size_t at = 0; at + 12 <= bytes.size();) {
        const auto type = driver::get<std::uint32_t>(bytes, at);
        const auto length = driver::get<std::uint32_t>(bytes, at + 4);
        if (length < 12 || length > bytes.size() - at) break;
        if (type == kPacketBlock && length >= kPacketHead + kUsbmonHead) {
            ++traffic.packets;
            const auto packet = bytes.subspan(at + kPacketHead, length - kPacketHead - 4);
            const auto captured = driver::get<std::uint32_t>(packet, 36);
            if (packet[8] == 'C' && packet[9] == kBulk && (packet[10] & kIn) != 0 &&
                captured <= packet.size() - kUsbmonHead) {
                const auto data = packet.subspan(kUsbmonHead, captured);
                traffic.bulkIn.push_back({.endpoint = packet[10],
                                          .status = driver::get<std::int32_t>(packet, 28),
                                          .bytes = {data.begin(), data.end()}});
            }
        }
        at += length;
    }
    return traffic;
}

/// Request, result, type, endpoint, status, flags, buffer's and actual length, iso, hex bytes.
ForeignTraffic readLog(std::istream& in) {
    ForeignTraffic traffic;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string request, hex;
        int result = 0, type = 0, endpoint = 0, status = 0, flags = 0, room = 0, length = 0,
            iso = 0;
        words >> request >> result >> type >> endpoint >> status >> flags >> room >> length >> iso;
        if (!words || request != "USBDEVFS_REAPURBNDELAY") continue;
        ++traffic.packets;
        if (type != kBulk || (endpoint & kIn) == 0) continue;
        words >> hex;
        ForeignTransfer transfer{
            .endpoint = endpoint, .status = status, .requested = room, .bytes = {}};
        for (std::size_t i = 0; i + 1 < hex.size() && i / 2 < static_cast<std::size_t>(length);
             i += 2)
            transfer.bytes.push_back(
                static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
        traffic.bulkIn.push_back(std::move(transfer));
    }
    return traffic;
}

}  // namespace

ForeignTraffic readForeign(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (file.extension() != ".pcapng") return readLog(in);
    return readPackets({std::istreambuf_iterator<char>(in), {}});
}

}  // namespace gonio::device_test
