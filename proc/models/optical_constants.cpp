#include "proc/models/optical_constants.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kMostRows = 100000;

struct Row {
    double micrometres;
    double eta;
    double k;
};

/// Three numbers and nothing else.
std::optional<Row> rowOf(const std::string& line) {
    std::istringstream words(line);
    std::vector<double> numbers;
    for (std::string word; words >> word;) {
        const auto number = parseDouble(word);
        if (!number || numbers.size() == 3) return std::nullopt;
        numbers.push_back(*number);
    }
    if (numbers.size() != 3) return std::nullopt;
    return Row{numbers[0], numbers[1], numbers[2]};
}

bool blank(const std::string& line) { return line.find_first_not_of(" \t\r") == std::string::npos; }

Result<std::vector<Row>> tableOf(std::istream& in) {
    const auto bad = [](const std::string& what) { return Error{ErrorKind::File, what}; };
    std::string line;
    bool tabulated = false;
    while (std::getline(in, line)) {
        tabulated = tabulated || line.find("type: tabulated nk") != std::string::npos;
        if (tabulated && line.find("data: |") != std::string::npos) break;
    }
    if (!in) return bad("no table of 'type: tabulated nk'");
    std::vector<Row> rows;
    while (std::getline(in, line)) {
        if (blank(line)) continue;
        if (line.front() != ' ') break;  // the next key
        const auto row = rowOf(line);
        if (!row) return bad("'" + line.substr(0, 40) + "' is no row of wavelength, n and k");
        if (!rows.empty() && row->micrometres <= rows.back().micrometres) {
            return bad("wavelengths must rise, " + shortest(row->micrometres) + " um does not");
        }
        if (rows.size() == kMostRows) return bad("more than 100000 rows");
        rows.push_back(*row);
    }
    return rows;
}

/// Linear between rows; empty outside the table.
std::optional<Row> rowAt(const std::vector<Row>& rows, double micrometres) {
    const auto above = std::find_if(
        rows.begin(), rows.end(), [&](const Row& row) { return row.micrometres >= micrometres; });
    if (above == rows.end()) return std::nullopt;
    if (above->micrometres == micrometres) return *above;
    if (above == rows.begin()) return std::nullopt;
    const Row& low = *(above - 1);
    const double share = (micrometres - low.micrometres) / (above->micrometres - low.micrometres);
    return Row{.micrometres = micrometres,
               .eta = low.eta + (above->eta - low.eta) * share,
               .k = low.k + (above->k - low.k) * share};
}

}  // namespace

Result<OpticalConstants> readOpticalConstants(const std::filesystem::path& file) {
    const std::string name = "'" + file.string() + "'";
    std::ifstream in(file);
    if (!in) return Error{ErrorKind::File, name + ": cannot be opened"};
    const Result<std::vector<Row>> rows = tableOf(in);
    if (!rows) return rows.error().in(name);
    if (rows->empty()) return Error{ErrorKind::File, name + ": the table has no rows"};
    OpticalConstants constants;
    for (Band band : kBands) {
        const double wanted = nanometres(band) * 1e-3;
        const std::optional<Row> at = rowAt(*rows, wanted);
        if (!at) {
            return Error{ErrorKind::File,
                         name + ": the table goes from " + shortest(rows->front().micrometres) +
                             " to " + shortest(rows->back().micrometres) + " um, wanted " +
                             shortest(nanometres(band)) + " nm"};
        }
        if (!(at->eta >= 1e-3 && at->eta <= 1e3 && at->k >= 0 && at->k <= 1e3)) {
            return Error{ErrorKind::File,
                         name + ": at " + shortest(nanometres(band)) +
                             " nm n = " + shortest(at->eta) + ", k = " + shortest(at->k) +
                             ": wanted n in [0.001, 1000], k in [0, 1000]"};
        }
        constants.eta[band] = at->eta;
        constants.k[band] = at->k;
    }
    return constants;
}

}  // namespace gonio::proc
