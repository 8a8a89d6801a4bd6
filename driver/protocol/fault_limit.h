#pragma once
// How often a stream may fail and be mended (PROTOCOL.md 4): three times in ten seconds is a fault.
// And how long it may have no memory for a single transfer.

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "driver/protocol/constants.h"
#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio::driver {

class FaultLimit {
public:
    static constexpr Nanoseconds kSpan = std::chrono::seconds(10);

    /// Another failure; true when it is the third of the span.
    bool third(Nanoseconds now) {
        const bool tooOften = last_[0] && now - *last_[0] < kSpan;
        last_ = {last_[1], now};
        return tooOften;
    }

private:
    std::array<std::optional<Nanoseconds>, 2> last_{};
};

/// With nothing in flight a stream tries again for so long, and has failed then.
inline constexpr Nanoseconds kMemoryLimit = std::chrono::seconds(5);

/// `kept` of a ring's transfers are kept.
[[nodiscard]] inline std::string memoryHint(const std::string& rig, int kept) {
    return rig + ": the system has no memory for more USB transfers, " + std::to_string(kept) +
           " are kept; write a larger number into /sys/module/usbcore/parameters/usbfs_memory_mb";
}

/// After the third. Its status, LINK, says that the rig is there and that opening it anew is no
/// cure.
[[nodiscard]] inline Error streamFault(const std::string& rig) {
    return {ErrorKind::Device,
            rig + ": its stream failed three times in 10 s; check its cable and hub",
            status::kLink};
}

}  // namespace gonio::driver
