#pragma once
// What a test program allocates by `new`.

#include <cstddef>

namespace gonio::test {

/// Since the program started, all threads.
[[nodiscard]] std::size_t allocationCount();

}  // namespace gonio::test
