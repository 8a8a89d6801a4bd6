#pragma once
// The most that a test program holds at once of what it allocates by `new`.

#include <cstddef>

namespace gonio::test {

/// From its making on, all threads: bytes above what was held then.
class AllocationPeak {
public:
    AllocationPeak();
    [[nodiscard]] std::size_t bytes() const;

private:
    std::size_t held_;
};

}  // namespace gonio::test
