#pragma once
// Files under GONIO_DATA_DIR; none, with one line said, where they are absent.

#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

namespace gonio::test {

inline std::optional<std::filesystem::path> dataFile(const std::string& name) {
    const std::filesystem::path file = std::filesystem::path(GONIO_DATA_DIR) / name;
    if (std::filesystem::exists(file)) return file;
    std::cout << "skipped: no " << name << " in GONIO_DATA_DIR\n";
    return std::nullopt;
}

}  // namespace gonio::test
