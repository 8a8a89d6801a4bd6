#pragma once
// How often a stream may fail and be mended (PROTOCOL.md 4): three times in ten seconds is a fault.

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

/// After the third. Its status, LINK, says that the rig is there and that opening it anew is no
/// cure.
[[nodiscard]] inline Error streamFault(const std::string& rig) {
    return {ErrorKind::Device,
            rig + ": its stream failed three times in 10 s; check its cable and hub",
            status::kLink};
}

}  // namespace gonio::driver
