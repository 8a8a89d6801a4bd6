#pragma once
// Which seeds a run of the tests plays a row with: GONIO_FAULT_SEEDS=20 the first so many,
// GONIO_FAULT_SEED=7 that one alone, GONIO_NIGHTLY the full count of the door.

// Anything else in these two is refused: no seed at all would pass.

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

#include "proc/core/number_text.h"
#include "tests/faults/row.h"

namespace gonio::fault_test {

struct Seeds {
    int first = 1, last = 1;
};

/// Empty where the variable is not set. Throws where it is no number from 1 on.
[[nodiscard]] inline std::optional<int> seedIn(const char* variable) {
    const char* text = std::getenv(variable);
    if (!text) return std::nullopt;
    const auto number = parseInteger(text);
    if (!number || *number < 1 || *number > 1'000'000)
        throw std::runtime_error(std::string(variable) + "=" + text + ": wanted a number from 1");
    return static_cast<int>(*number);
}

/// Of a script that is played with one seed.
[[nodiscard]] inline std::uint64_t seedOr(std::uint64_t usual) {
    const auto only = seedIn("GONIO_FAULT_SEED");
    return only ? static_cast<std::uint64_t>(*only) : usual;
}

[[nodiscard]] inline Seeds seedsOf(int nightly) {
    if (const auto only = seedIn("GONIO_FAULT_SEED")) return {*only, *only};
    if (const auto many = seedIn("GONIO_FAULT_SEEDS")) return {1, *many};
    return {1, std::getenv("GONIO_NIGHTLY") != nullptr ? nightly : 1};
}

/// "F06-third" as a test may be called.
[[nodiscard]] inline std::string testName(std::string row) {
    std::erase(row, '-');
    return row;
}

}  // namespace gonio::fault_test
