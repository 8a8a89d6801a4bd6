#include "daemon/cli/output.h"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

namespace gonio::daemon {

void printJson(const nlohmann::ordered_json& json) {
    std::cout << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
}

void printTable(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            line += row[i];
            if (i + 1 < row.size()) line += std::string(widths[i] - row[i].size() + 2, ' ');
        }
        std::cout << line << "\n";
    }
}

std::string markdownTable(const std::vector<std::vector<std::string>>& rows) {
    std::string text;
    const auto add = [&](const std::vector<std::string>& cells) {
        text += "|";
        for (const std::string& cell : cells) text += " " + cell + " |";
        text += "\n";
    };
    for (const auto& row : rows) {
        add(row);
        if (&row == &rows.front()) add(std::vector<std::string>(row.size(), "---"));
    }
    return text;
}

Result<void> makeOutputFolder(const std::filesystem::path& folder) {
    if (folder.empty()) return {};
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    std::error_code ignored;
    if (std::filesystem::is_directory(folder, ignored)) return {};
    return Error{ErrorKind::File,
                 folder.string() + ": wanted a folder to write to" +
                     (failed ? ", " + failed.message() : "")};
}

Result<void> checkOutputFile(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) {
        return Error{ErrorKind::File,
                     file.string() + ": is a folder; name a file in it to write to"};
    }
    const std::filesystem::path folder = file.parent_path();
    if (folder.empty() || std::filesystem::is_directory(folder, ignored)) return {};
    return Error{ErrorKind::File,
                 file.string() + ": there is no folder " + folder.string() + " to write to"};
}

}  // namespace gonio::daemon
