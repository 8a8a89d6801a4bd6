#pragma once
// How the commands print on stdout: JSON for machines, tables for people.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace gonio::daemon {

/// What is no UTF-8 is replaced.
void printJson(const nlohmann::ordered_json& json);
/// Columns as wide as their widest word.
void printTable(const std::vector<std::vector<std::string>>& rows);

}  // namespace gonio::daemon
