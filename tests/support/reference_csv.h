#pragma once
// Rows of the 60-digit reference tables; empty, with one line said, where they are absent.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "proc/core/number_text.h"

namespace gonio::test {

inline std::vector<std::vector<double>> referenceRows(const std::string& table) {
    const std::filesystem::path file =
        std::filesystem::path(GONIO_DATA_DIR) / "reference-brdf" / (table + ".csv");
    std::ifstream in(file);
    if (!in) {
        std::cout << "skipped: " << table << ": no " << file.filename().string()
                  << " in GONIO_DATA_DIR\n";
        return {};
    }
    std::vector<std::vector<double>> rows;
    std::string line;
    std::getline(in, line);  // names of the columns
    while (std::getline(in, line)) {
        std::istringstream cells(line);
        std::vector<double> row;
        for (std::string cell; std::getline(cells, cell, ',');) {
            row.push_back(gonio::parseDouble(cell).value());
        }
        rows.push_back(row);
    }
    return rows;
}

}  // namespace gonio::test
