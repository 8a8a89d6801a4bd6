#include "proc/formats/points_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/formats/csv_rows.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

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
    CsvRows rows(text, name);
    Points points;
    while (rows.next()) {
        points.rows.emplace_back(rows.line());
        points.pairs.push_back(rows.pair());
    }
    if (rows.error()) return *rows.error();
    points.columns = rows.columns();
    return points;
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
    std::vector<std::string_view> fields;
    numbers.reserve(points.rows.size());
    for (std::size_t i = 0; i < points.rows.size(); ++i) {
        fields = csvFields(points.rows[i], std::move(fields));
        const std::string_view field = fields[place];
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
        text += csvName((taken ? "input_" : "") + column) + ",";
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

}  // namespace gonio::proc
