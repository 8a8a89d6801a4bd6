#pragma once
// The computer's own monotonic clock.

#include <chrono>

#include "proc/core/stopwatch.h"

namespace gonio::driver {

class SteadyClock : public Clock {
public:
    [[nodiscard]] Nanoseconds now() const override {
        return std::chrono::steady_clock::now().time_since_epoch();
    }
};

}  // namespace gonio::driver
