#include "proc/formats/points_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/shown.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr std::array<std::string_view, 4> kAngles{"theta_i", "phi_i", "theta_o", "phi_o"};
constexpr std::array<std::string_view, 6> kVectors{"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};

std::string_view trimmed(std::string_view field) {
    const auto space = [](char c) { return c == ' ' || c == '\t'; };
    while (!field.empty() && space(field.front())) field.remove_prefix(1);
    while (!field.empty() && space(field.back())) field.remove_suffix(1);
    return field;
}

std::string_view unquoted(std::string_view field) {
    field = trimmed(field);
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
        return trimmed(field.substr(1, field.size() - 2));
    }
    return field;
}

constexpr std::size_t kMostColumns = 4096;

/// Commas inside double quotes do not separate. At most one field more than a header may have.
std::vector<std::string_view> fieldsOf(std::string_view line) {
    std::vector<std::string_view> fields;
    std::size_t start = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < line.size() && fields.size() < kMostColumns; ++i) {
        if (line[i] == '"') quoted = !quoted;
        if (line[i] != ',' || quoted) continue;
        fields.push_back(unquoted(line.substr(start, i - start)));
        start = i + 1;
    }
    fields.push_back(unquoted(line.substr(start)));
    return fields;
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

std::string quotedIfNeeded(const std::string& name) {
    if (name.find_first_of(",\"") == std::string::npos && !name.starts_with('#')) return name;
    std::string quoted = "\"";
    for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

std::string joined(std::span<const std::string_view> names) {
    std::string list;
    for (const std::string_view name : names) list += (list.empty() ? "" : ",") + std::string(name);
    return list;
}

/// From degrees as a file gives them: 90 degrees is on the horizon, not 6e-17 above it.
Direction fromFileDegrees(double theta, double phi) {
    Direction w = Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
    if (theta < 90 || w.z() <= 0) return w;
    return *Direction::fromVector({w.x(), w.y(), 0});
}

class PointsReader {
public:
    PointsReader(std::string_view text, std::string_view name) : text_(text), name_(name) {}

    Result<Points> read() {
        if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // UTF-8 byte order mark
        while (const auto line = nextLine()) {
            const bool good = points_.columns.empty() ? header(*line) : row(*line);
            if (!good || !quotesEnd(*line)) return *error_;
        }
        if (points_.columns.empty()) {
            fail("no header, wanted " + joined(kAngles) + " or " + joined(kVectors));
            return *error_;
        }
        return std::move(points_);
    }

private:
    bool fail(const std::string& what) {
        error_ =
            Error{ErrorKind::File,
                  "csv: " + std::string(name_) + ": line " + std::to_string(line_) + ": " + what};
        return false;
    }

    /// The next line that says something. A line ends in LF, CR LF or a bare CR.
    std::optional<std::string_view> nextLine() {
        while (at_ < text_.size()) {
            const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
            const std::string_view line = text_.substr(at_, end - at_);
            at_ = end + (text_.substr(end).starts_with("\r\n") ? 2 : 1);
            ++line_;
            const std::string_view content = trimmed(line);
            if (!content.empty() && content.front() != '#') return line;
        }
        return std::nullopt;
    }

    bool quotesEnd(std::string_view line) {
        const bool even = std::count(line.begin(), line.end(), '"') % 2 == 0;
        return even || fail("a quoted field does not end on its line");
    }

    bool header(std::string_view line) {
        const std::vector<std::string_view> fields = fieldsOf(line);
        if (fields.size() > kMostColumns) {
            return fail("more than " + std::to_string(kMostColumns) + " columns");
        }
        for (const std::string_view field : fields) points_.columns.push_back(nameIn(field));
        const auto& columns = points_.columns;
        const auto count = [&](std::string_view name) {
            return std::count(columns.begin(), columns.end(), name);
        };
        const auto all = [&](std::span<const std::string_view> names) {
            return std::all_of(names.begin(), names.end(), [&](auto n) { return count(n) > 0; });
        };
        const bool angles = all(kAngles);
        vectors_ = all(kVectors);
        if (angles == vectors_) {
            return fail(std::string(angles ? "both kinds of directions" : "no directions") +
                        " in the header " + shown(line) + ", wanted " + joined(kAngles) + " or " +
                        joined(kVectors));
        }
        const auto wanted = vectors_ ? std::span<const std::string_view>(kVectors)
                                     : std::span<const std::string_view>(kAngles);
        for (const std::string_view name : wanted) {
            if (count(name) > 1) return fail("column " + std::string(name) + " is there twice");
            const auto at = std::find(columns.begin(), columns.end(), name) - columns.begin();
            places_.push_back(static_cast<std::size_t>(at));
        }
        return true;
    }

    bool row(std::string_view line) {
        const std::vector<std::string_view> fields = fieldsOf(line);
        if (fields.size() != points_.columns.size()) {
            return fail(std::to_string(fields.size()) + " fields, the header has " +
                        std::to_string(points_.columns.size()));
        }
        std::array<double, 6> number{};
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const auto value = parseDouble(fields[places_[i]]);
            if (!value) {
                return fail(points_.columns[places_[i]] + ": " + shown(fields[places_[i]]) +
                            ", wanted a number");
            }
            number[i] = *value;
        }
        if (!(vectors_ ? fromVectors(number) : fromAngles(number))) return false;
        points_.rows.emplace_back(line);
        return true;
    }

    bool fromAngles(const std::array<double, 6>& n) {
        for (const std::size_t i : {0U, 2U}) {
            if (n[i] < 0 || n[i] > 180) {
                return fail(std::string(kAngles[i]) + ": " + shortest(n[i]) +
                            ", wanted degrees in [0, 180]");
            }
        }
        points_.pairs.push_back(
            {.in = fromFileDegrees(n[0], n[1]), .out = fromFileDegrees(n[2], n[3])});
        return true;
    }

    bool fromVectors(const std::array<double, 6>& n) {
        const auto in = Direction::fromVector({n[0], n[1], n[2]});
        const auto out = Direction::fromVector({n[3], n[4], n[5]});
        if (!in || !out) return fail(std::string(in ? "wo" : "wi") + " has no length");
        points_.pairs.push_back({.in = *in, .out = *out});
        return true;
    }

    std::string_view text_;
    std::string_view name_;
    std::size_t at_ = 0;
    int line_ = 0;
    Points points_;
    std::vector<std::size_t> places_;  ///< columns of the numbers, in the order of their names
    bool vectors_ = false;
    std::optional<Error> error_;
};

std::string orEmpty(double value) { return std::isfinite(value) ? shortest(value) : ""; }

/// "f" or "f_r", "f_g", "f_b".
std::vector<std::string> perBand(const std::string& name, BandCount bands) {
    if (bands == BandCount::One) return {name};
    std::vector<std::string> names;
    names.reserve(kBands.size());
    for (const Band b : kBands) names.push_back(name + "_" + std::string(letter(b)));
    return names;
}

std::span<const Band> shownBands(BandCount bands) {
    return std::span(kBands).first(bands == BandCount::One ? 1 : kBands.size());
}

}  // namespace

Result<Points> parsePoints(std::string_view text, std::string_view name) {
    return PointsReader(text, name).read();
}

Result<Points> readPoints(const std::filesystem::path& path) {
    const Result<std::string> text = readFile(path);
    if (!text) return text.error();
    return parsePoints(*text, path.string());
}

Result<std::vector<double>> numbersOf(const Points& points, std::string_view column) {
    const auto found = std::find(points.columns.begin(), points.columns.end(), column);
    if (found == points.columns.end()) {
        return Error{ErrorKind::File, "csv: no column " + std::string(column)};
    }
    const auto place = static_cast<std::size_t>(found - points.columns.begin());
    std::vector<double> numbers;
    numbers.reserve(points.rows.size());
    for (std::size_t i = 0; i < points.rows.size(); ++i) {
        const std::string_view field = fieldsOf(points.rows[i])[place];
        const bool empty = field.empty() || field == "nan";
        const std::optional<double> number =
            empty ? std::numeric_limits<double>::quiet_NaN() : parseDouble(field);
        if (!number) {
            return Error{ErrorKind::File,
                         "csv: data row " + std::to_string(i + 1) + ": " + std::string(column) +
                             ": " + shown(field) + ", wanted a number"};
        }
        numbers.push_back(*number);
    }
    return numbers;
}

std::string evalCsv(const Points& points, std::span<const Answer> answers, BandCount bands) {
    const bool withU = std::any_of(answers.begin(), answers.end(), [](const Answer& a) {
        return a.uRandom.has_value() || a.uSystematic.has_value();
    });
    std::vector<std::string> ours = perBand("f", bands);
    if (withU) {
        for (const std::string& name : perBand("u", bands)) ours.push_back(name);
    }
    ours.emplace_back("flags");
    ours.emplace_back("source");

    std::string text;
    for (const std::string& column : points.columns) {
        const bool taken = std::find(ours.begin(), ours.end(), column) != ours.end();
        text += quotedIfNeeded((taken ? "input_" : "") + column) + ",";
    }
    for (const std::string& column : ours) text += column + (column == "source" ? "\n" : ",");
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const Answer& answer = answers[i];
        text += points.rows[i];
        for (const Band b : shownBands(bands)) text += "," + orEmpty(answer.f[b]);
        for (const Band b : shownBands(bands)) {
            const auto u = answer.u(b);
            if (withU) text += "," + (u ? orEmpty(*u) : "");
        }
        text += "," + std::to_string(answer.flags.mask()) + "," + std::string(name(answer.source));
        text += "\n";
    }
    return text;
}

std::string sampleCsv(const SampleSet& set) {
    std::string text = "theta_i,phi_i,theta_o,phi_o";
    for (const char* column : {"f", "u", "u_random", "u_systematic", "flags"}) {
        for (const std::string& name : perBand(column, BandCount::Three)) text += "," + name;
    }
    text += "\n";
    for (const LedTable& led : set.leds) {
        const std::string incidence = shortest(fileDegrees(led.incidence)) + "," +
                                      shortest(fileDegrees(rotationOf(-led.rotation.degrees()))) +
                                      ",";
        for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
            const Direction wo = pairInSample(led, CellGrid::centre(cell)).out;
            text += incidence + shortest(fileDegrees(wo.theta())) + "," +
                    shortest(fileDegrees(wo.phi()));
            std::array<Measured<double>, 3> at;
            for (const Band b : kBands) {
                const CellSamples& cells = led.bands[index(b)];
                at[index(b)] = cell < cells.size() ? cells.at(cell) : Measured<double>::missing();
            }
            for (const auto& m : at) text += "," + orEmpty(m.value);
            for (const auto& m : at) text += "," + orEmpty(m.u());
            for (const auto& m : at) text += "," + orEmpty(m.uRandom);
            for (const auto& m : at) text += "," + orEmpty(m.uSystematic);
            for (const auto& m : at) text += "," + std::to_string(m.flags.mask());
            text += "\n";
        }
    }
    return text;
}

}  // namespace gonio::proc
