#pragma once
// capture_id = plan step << 16 | attempt. Attempts count from 1, so that no id is 0, and go on when
// a step comes again: no id is used twice while the rig may still hold frames of it. 65535 attempts
// at one step wrap.

#include <cstdint>
#include <vector>

namespace gonio::driver {

class CaptureIds {
public:
    CaptureIds();
    /// Allocates nothing.
    [[nodiscard]] std::uint64_t next(std::uint64_t planStep);
    [[nodiscard]] static std::uint64_t planStepOf(std::uint64_t captureId) {
        return captureId >> kAttemptBits;
    }

private:
    static constexpr int kAttemptBits = 16;
    struct Used {
        std::uint64_t planStep = 0;
        std::uint16_t attempt = 0;
    };
    std::vector<Used> recent_;  ///< newest last
};

}  // namespace gonio::driver
