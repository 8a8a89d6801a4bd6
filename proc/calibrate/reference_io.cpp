#include "proc/calibrate/reference_io.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kColumns = "theta_i,theta_o,phi_o,f_r,f_g,f_b";
constexpr std::size_t kColumnCount = 6;
using Row = std::array<double, kColumnCount>;

Error atLine(int line, const std::string& what) {
    return {ErrorKind::File, "line " + std::to_string(line) + ": " + what};
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

Result<void> readComment(std::string_view text, int line, Certificate& certificate) {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos) return {};
    const std::string_view key = trimmed(text.substr(0, colon));
    const std::string_view value = trimmed(text.substr(colon + 1));
    if (key == "name") certificate.name = value;
    if (key == "citation") certificate.citation = value;
    if (key == "licence") certificate.licence = value;
    if (key != "u_common" && key != "u_per_direction") return {};
    const auto u = parseDouble(value);
    if (!u || *u < 0 || *u >= 1) {
        return atLine(line, std::string(key) + ": wanted a fraction in [0, 1)");
    }
    (key == "u_common" ? certificate.uCommon : certificate.uPerDirection) = *u;
    return {};
}

Result<Row> readRow(std::string_view text, int line) {
    Row row{};
    std::size_t column = 0;
    while (true) {
        const auto comma = text.find(',');
        const std::string_view cell = trimmed(text.substr(0, comma));
        const auto value = parseDouble(cell);
        if (column == kColumnCount || !value) {
            return atLine(line,
                          column == kColumnCount ? "more than 6 columns"
                                                 : "'" + std::string(cell) + "' is not a number");
        }
        row[column++] = *value;
        if (comma == std::string_view::npos) break;
        text.remove_prefix(comma + 1);
    }
    if (column != kColumnCount) {
        return atLine(line, std::to_string(column) + " columns, wanted " + std::string(kColumns));
    }
    return row;
}

/// One incidence's rows, sorted, as a grid; ReferenceTable::make checks that it is a full one.
ReferencePlane toPlane(double incidence, std::vector<Row> rows) {
    std::sort(rows.begin(), rows.end());
    ReferencePlane plane{
        .incidence = Radians::fromDegrees(incidence), .theta = {}, .phi = {}, .f = {}};
    for (const Row& row : rows) {
        const Radians theta = Radians::fromDegrees(row[1]);
        if (plane.theta.empty() || plane.theta.back() != theta) plane.theta.push_back(theta);
        if (plane.theta.size() == 1) plane.phi.push_back(Radians::fromDegrees(row[2]));
        plane.f.push_back({{row[3], row[4], row[5]}});
    }
    return plane;
}

bool sameGrid(const std::vector<Row>& rows, std::size_t columns) {
    for (std::size_t i = columns; i < rows.size(); ++i) {
        if (rows[i][2] != rows[i % columns][2]) return false;
    }
    return true;
}

}  // namespace

Result<ReferenceTable> parseReference(std::string_view text) {
    Certificate certificate;
    std::map<double, std::vector<Row>> byIncidence;
    bool header = false;
    int line = 0;
    while (!text.empty()) {
        const auto end = text.find('\n');
        const std::string_view content = trimmed(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++line;
        if (content.empty()) continue;
        if (content.front() == '#') {
            const auto read = readComment(content.substr(1), line, certificate);
            if (!read) return read.error();
        } else if (!header) {
            if (content != kColumns) return atLine(line, "wanted " + std::string(kColumns));
            header = true;
        } else {
            const auto row = readRow(content, line);
            if (!row) return row.error();
            byIncidence[row->front()].push_back(*row);
        }
    }
    std::vector<ReferencePlane> planes;
    for (auto& [incidence, rows] : byIncidence) {
        std::sort(rows.begin(), rows.end());
        ReferencePlane plane = toPlane(incidence, rows);
        if (!sameGrid(rows, plane.phi.size())) {
            return Error{ErrorKind::File,
                         "incidence " + shortest(incidence) + ": phi_o differs between theta_o"};
        }
        planes.push_back(std::move(plane));
    }
    return ReferenceTable::make(std::move(certificate), std::move(planes));
}

Result<ReferenceTable> readReference(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    if (!in || !(text << in.rdbuf())) {
        return Error{ErrorKind::File, file.string() + ": cannot be read"};
    }
    auto table = parseReference(text.str());
    if (!table) return table.error().in(file.string());
    return table;
}

}  // namespace gonio::proc
