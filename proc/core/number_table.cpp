#include "proc/core/number_table.h"

#include <cmath>
#include <fstream>
#include <string_view>

#include "proc/core/number_text.h"

namespace gonio {
namespace {

constexpr std::size_t kMostRows = 100000;

std::vector<std::string_view> cellsOf(std::string_view line) {
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    std::vector<std::string_view> cells;
    for (std::size_t start = 0;;) {
        const std::size_t comma = line.find(',', start);
        cells.push_back(line.substr(start, comma - start));
        if (comma == std::string_view::npos) return cells;
        start = comma + 1;
    }
}

}  // namespace

Result<NumberTable> readNumberTable(const std::filesystem::path& file) {
    const std::string name = "'" + file.string() + "'";
    const auto bad = [&](std::size_t line, const std::string& what) {
        return Error{ErrorKind::File, name + ": line " + std::to_string(line) + ": " + what};
    };
    std::ifstream in(file);
    if (!in) return Error{ErrorKind::File, name + ": cannot be opened"};
    std::string line;
    if (!std::getline(in, line)) return bad(1, "empty, wanted the names of the columns");
    NumberTable table;
    for (std::string_view cell : cellsOf(line)) table.names.emplace_back(cell);
    for (std::size_t number = 2; std::getline(in, line); ++number) {
        if (line.empty() || line == "\r") continue;
        const std::vector<std::string_view> cells = cellsOf(line);
        if (cells.size() != table.names.size()) {
            return bad(number,
                       std::to_string(cells.size()) + " cells, the header names " +
                           std::to_string(table.names.size()));
        }
        std::vector<double> row;
        for (std::string_view cell : cells) {
            const auto value = parseDouble(cell);
            if (!value)
                return bad(number, "'" + std::string(cell.substr(0, 40)) + "' is no number");
            row.push_back(*value);
        }
        if (table.rows.size() == kMostRows) return bad(number, "more than 100000 rows");
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace gonio
