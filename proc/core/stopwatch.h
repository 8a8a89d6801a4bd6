#pragma once
// Time is passed in, never read: proc knows no clock. A rig in virtual time and a real one differ
// only in the Clock that main (or a test) hands down.

#include "proc/core/units.h"

namespace gonio {

/// Monotonic time since an arbitrary origin.
class Clock {
public:
    virtual ~Clock() = default;
    [[nodiscard]] virtual Nanoseconds now() const = 0;
};

/// Seconds since it was made, on the clock it was given (borrowed: the clock must outlive it).
class Stopwatch {
public:
    explicit Stopwatch(const Clock& clock) : clock_(&clock), start_(clock.now()) {}
    [[nodiscard]] Seconds elapsed() const { return Seconds(clock_->now() - start_); }

private:
    const Clock* clock_;
    Nanoseconds start_;
};

}  // namespace gonio
