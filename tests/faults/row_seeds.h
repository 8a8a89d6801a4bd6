#pragma once
// Which seeds a run of the tests plays a row with: GONIO_FAULT_SEEDS=20 the first so many,
// GONIO_FAULT_SEED=7 that one alone, GONIO_NIGHTLY the full count of the door.

#include <cstdint>
#include <cstdlib>
#include <utility>

#include "tests/faults/row.h"

namespace gonio::fault_test {

struct Seeds {
    int first = 1, last = 1;
};

/// Of a script that is played with one seed.
[[nodiscard]] inline std::uint64_t seedOr(std::uint64_t usual) {
    const char* only = std::getenv("GONIO_FAULT_SEED");
    return only ? std::strtoull(only, nullptr, 10) : usual;
}

[[nodiscard]] inline Seeds seedsOf(const Row& row, int nightly) {
    if (const char* only = std::getenv("GONIO_FAULT_SEED"))
        return {std::atoi(only), std::atoi(only)};
    if (const char* many = std::getenv("GONIO_FAULT_SEEDS")) return {1, std::atoi(many)};
    return {1, std::getenv("GONIO_NIGHTLY") != nullptr ? nightly : row.seeds};
}

/// "F06-third" as a test may be called.
[[nodiscard]] inline std::string testName(std::string row) {
    std::erase(row, '-');
    return row;
}

}  // namespace gonio::fault_test
