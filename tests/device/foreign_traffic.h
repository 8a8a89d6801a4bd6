#pragma once
// USB traffic of other devices, as others recorded it: usbmon's packets in pcapng (link type 220),
// and umockdev's logs of usbfs requests.

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gonio::device_test {

/// A bulk IN transfer that has ended.
struct ForeignTransfer {
    int endpoint = 0;
    int status = 0;     ///< as the kernel says it: 0, or minus an errno
    int requested = 0;  ///< bytes that the host had room for; 0 where the log does not say
    std::vector<std::uint8_t> bytes;
};

struct ForeignTraffic {
    int packets = 0;  ///< of any kind
    std::vector<ForeignTransfer> bulkIn;
};

/// By the name's end: .pcapng, else a log. Empty for what cannot be read.
[[nodiscard]] ForeignTraffic readForeign(const std::filesystem::path& file);

}  // namespace gonio::device_test
