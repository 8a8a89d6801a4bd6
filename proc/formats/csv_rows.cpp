#include "proc/formats/csv_rows.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

/// Of any file that was made to be read; a hostile one of a megabyte has no more memory than that.
constexpr std::size_t kMostColumns = 4096;

constexpr std::array<std::string_view, 4> kAngles{"theta_i", "phi_i", "theta_o", "phi_o"};
constexpr std::array<std::string_view, 6> kVectors{"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};

std::string_view unquoted(std::string_view field) {
    field = trimmed(field);
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
        return trimmed(field.substr(1, field.size() - 2));
    }
    return field;
}

/// A doubled quote stands for one.
std::string nameIn(std::string_view field) {
    std::string name;
    for (std::size_t i = 0; i < field.size(); ++i) {
        name += field[i];
        if (field.substr(i).starts_with("\"\"")) ++i;
    }
    return name;
}

std::string joined(std::span<const std::string_view> names) {
    std::string list;
    for (const std::string_view name : names) list += (list.empty() ? "" : ",") + std::string(name);
    return list;
}

std::string wantedNumber(std::string_view field) {
    const bool comma = field.find(',') != std::string_view::npos;
    return shown(field) + ", wanted a number" + (comma ? " with a decimal point" : "");
}

}  // namespace

std::vector<std::string_view> csvFields(std::string_view line,
                                        std::vector<std::string_view> reuse) {
    reuse.clear();
    std::size_t start = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < line.size() && reuse.size() < kMostColumns; ++i) {
        if (line[i] == '"') quoted = !quoted;
        if (line[i] != ',' || quoted) continue;
        reuse.push_back(unquoted(line.substr(start, i - start)));
        start = i + 1;
    }
    reuse.push_back(unquoted(line.substr(start)));
    return reuse;
}

std::string csvName(const std::string& name) {
    if (name.find_first_of(",\"") == std::string::npos && !name.starts_with('#')) return name;
    std::string quoted = "\"";
    for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

bool CsvRows::next() {
    while (!error_) {
        const auto line = nextLine();
        if (!line) break;
        const bool isHeader = columns_.empty();
        const bool good = isHeader ? header(*line) : row(*line);
        if (!good || !quotesEnd(*line)) return false;
        if (!isHeader) return true;
    }
    if (!error_ && columns_.empty()) {
        fail("no header, wanted " + joined(kAngles) + " or " + joined(kVectors));
    }
    return false;
}

bool CsvRows::fail(const std::string& what) {
    error_ = Error{
        ErrorKind::File,
        "csv: " + std::string(name_) + ": line " + std::to_string(lines_.number()) + ": " + what};
    return false;
}

std::optional<std::string_view> CsvRows::nextLine() {
    while (const auto line = lines_.next()) {
        std::string_view content = trimmed(*line);
        if (content.empty()) continue;
        if (content.front() != '#') return line;
        content.remove_prefix(1);
        if (content.starts_with(' ')) content.remove_prefix(1);
        if (comments_.size() == CommentLines::kMost) {
            fail("more than " + std::to_string(CommentLines::kMost) + " comments");
            return std::nullopt;
        }
        comments_.emplace_back(content);
    }
    return std::nullopt;
}

bool CsvRows::quotesEnd(std::string_view line) {
    const bool even = std::count(line.begin(), line.end(), '"') % 2 == 0;
    return even || fail("a quoted field does not end on its line");
}

bool CsvRows::header(std::string_view line) {
    fields_ = csvFields(line, std::move(fields_));
    if (fields_.size() > kMostColumns) {
        return fail("more than " + std::to_string(kMostColumns) + " columns");
    }
    for (const std::string_view field : fields_) columns_.push_back(nameIn(field));
    const auto count = [&](std::string_view name) {
        return std::count(columns_.begin(), columns_.end(), name);
    };
    const auto all = [&](std::span<const std::string_view> names) {
        return std::all_of(names.begin(), names.end(), [&](auto n) { return count(n) > 0; });
    };
    const bool angles = all(kAngles);
    vectors_ = all(kVectors);
    if (angles == vectors_) {
        const bool others = line.find_first_of(";\t") != std::string_view::npos;
        return fail(std::string(angles ? "both kinds of directions" : "no directions") +
                    " in the header " + shown(line) + ", wanted " + joined(kAngles) + " or " +
                    joined(kVectors) +
                    (others ? ", with commas between fields and points in numbers" : ""));
    }
    const auto wanted = vectors_ ? std::span<const std::string_view>(kVectors)
                                 : std::span<const std::string_view>(kAngles);
    for (const std::string_view name : wanted) {
        if (count(name) > 1) return fail("column " + std::string(name) + " is there twice");
        const auto at = std::find(columns_.begin(), columns_.end(), name) - columns_.begin();
        places_.push_back(static_cast<std::size_t>(at));
    }
    return true;
}

bool CsvRows::row(std::string_view line) {
    line_ = line;
    fields_ = csvFields(line, std::move(fields_));
    if (fields_.size() != columns_.size()) {
        return fail(std::to_string(fields_.size()) + " fields, the header has " +
                    std::to_string(columns_.size()) +
                    (fields_.size() > columns_.size() ? "; a decimal comma?" : ""));
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const auto value = parseDouble(fields_[places_[i]]);
        if (!value) {
            return fail(columns_[places_[i]] + ": " + wantedNumber(fields_[places_[i]]));
        }
        numbers_[i] = *value;
    }
    return vectors_ ? fromVectors() : fromAngles();
}

bool CsvRows::fromAngles() {
    for (const std::size_t i : {0U, 2U}) {
        if (numbers_[i] < 0 || numbers_[i] > 180) {
            return fail(std::string(kAngles[i]) + ": " + shortest(numbers_[i]) +
                        ", wanted degrees in [0, 180]");
        }
    }
    const auto at = [&](std::size_t i) { return Radians::fromDegrees(numbers_[i]); };
    pair_ = {.in = fileDirection(at(0), at(1)), .out = fileDirection(at(2), at(3))};
    return true;
}

bool CsvRows::fromVectors() {
    const auto& n = numbers_;
    const auto in = Direction::fromVector({n[0], n[1], n[2]});
    const auto out = Direction::fromVector({n[3], n[4], n[5]});
    if (!in || !out) return fail(std::string(in ? "wo" : "wi") + " has no length");
    pair_ = {.in = *in, .out = *out};
    return true;
}

std::optional<double> CsvRows::number(std::size_t column) {
    const std::string_view field = fields_[column];
    if (field.empty() || field == "nan") return std::numeric_limits<double>::quiet_NaN();
    const std::optional<double> number = parseDouble(field);
    if (!number) fail(columns_[column] + ": " + wantedNumber(field));
    return number;
}

}  // namespace gonio::proc
