#pragma once
// Waiting for what another thread or process does: until it is so, or a deadline that only a
// failure reaches.

#include <chrono>
#include <thread>

namespace gonio::test {

#ifdef __SANITIZE_THREAD__
inline constexpr bool kThreadSanitizer = true;
#else
inline constexpr bool kThreadSanitizer = false;
#endif

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
inline constexpr int kSlowdown = 10;  ///< of a build under a sanitizer, at most
#else
inline constexpr int kSlowdown = 1;
#endif

/// Ten times what the slowest step of a test takes on two busy cores.
inline constexpr std::chrono::seconds kPatience{20 * kSlowdown};

/// Whether `condition`, looked at this often, held before the deadline.
template <class Condition>
[[nodiscard]] bool waitUntil(Condition condition,
                             std::chrono::milliseconds deadline = kPatience,
                             std::chrono::milliseconds every = std::chrono::milliseconds(2)) {
    const auto end = std::chrono::steady_clock::now() + deadline;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(every);
    }
    return true;
}

}  // namespace gonio::test
