#pragma once
// What the commands have in common in how they answer: JSON for machines, tables for people, and
// the folder that files go to.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "proc/core/result.h"

namespace gonio::daemon {

/// What is no UTF-8 is replaced.
void printJson(const nlohmann::ordered_json& json);
/// Columns as wide as their widest word.
void printTable(const std::vector<std::vector<std::string>>& rows);
/// The first row is the head.
[[nodiscard]] std::string markdownTable(const std::vector<std::vector<std::string>>& rows);

/// Makes what -o names, before the work is done; an empty path is the working folder. A File error
/// names it.
[[nodiscard]] Result<void> makeOutputFolder(const std::filesystem::path& folder);

/// Before the work is done: a File error that names it where a file could not stand there, as it is
/// a folder, or its folder is not there.
[[nodiscard]] Result<void> checkOutputFile(const std::filesystem::path& file);

}  // namespace gonio::daemon
