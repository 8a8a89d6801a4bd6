#pragma once
// The 60-digit reference tables of tests/reference.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "proc/core/number_table.h"

namespace gonio::test {

inline std::filesystem::path referenceFolder() {
    return std::filesystem::path(GONIO_SOURCE_DIR) / "tests" / "reference";
}

/// Names, and rows of inputs and outputs; a failed test and no rows where it cannot be read.
inline NumberTable referenceTable(const std::string& name) {
    auto table = readNumberTable(referenceFolder() / (name + ".csv"));
    if (table) return std::move(*table);
    ADD_FAILURE() << table.error().message;
    return {};
}

}  // namespace gonio::test
