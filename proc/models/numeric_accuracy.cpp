#include "proc/models/numeric_accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/number_table.h"
#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

template <class T>
double errorIn(double value, double reference) {
    if (std::isnan(value)) return std::numeric_limits<double>::infinity();
    const auto least = static_cast<double>(std::numeric_limits<T>::min());
    const double distance = std::abs(value - reference);
    if (std::abs(reference) > least) return distance / std::abs(reference);
    return distance <= least ? 0 : distance / least;
}

/// The index in `names` of each of `wanted`.
Result<std::vector<std::size_t>> columnsOf(const std::vector<std::string>& names,
                                           const std::vector<std::string_view>& wanted) {
    std::vector<std::size_t> columns;
    for (std::string_view name : wanted) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
            return Error{ErrorKind::File, "no column '" + std::string(name) + "'"};
        }
        columns.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    return columns;
}

std::vector<double> picked(const std::vector<double>& row,
                           const std::vector<std::size_t>& columns) {
    std::vector<double> values;
    values.reserve(columns.size());
    for (std::size_t column : columns) values.push_back(row[column]);
    return values;
}

int decadeOf(double alpha) {
    // Table values such as 1e-7 are the nearest float, a little above or below.
    return static_cast<int>(std::floor(std::log10(alpha) + 1e-6));
}

/// The input that is an alpha, if one is.
std::optional<std::size_t> alphaOf(const ReferenceTable& table) {
    for (std::size_t i = 0; i < table.inputs.size(); ++i) {
        if (table.inputs[i] == "alpha" || table.inputs[i] == "alpha_x") return i;
    }
    return std::nullopt;
}

Result<std::vector<ColumnAccuracy>> accuracyOf(const ReferenceTable& table,
                                               const NumberTable& numbers) {
    const auto inputs = columnsOf(numbers.names, table.inputs);
    if (!inputs) return inputs.error();
    const auto outputs = columnsOf(numbers.names, table.outputs);
    if (!outputs) return outputs.error();
    std::vector<ColumnAccuracy> columns;
    columns.reserve(table.outputs.size());
    for (std::string_view output : table.outputs) {
        columns.push_back({.table = std::string(table.name),
                           .column = std::string(output),
                           .directions = table.directions,
                           .rows = numbers.rows.size()});
    }
    const std::optional<std::size_t> alpha = alphaOf(table);
    if (numbers.rows.empty()) return Error{ErrorKind::File, "a head without rows"};
    for (const std::vector<double>& row : numbers.rows) {
        const std::vector<double> in = picked(row, *inputs);
        if (alpha && !(in[*alpha] > 0)) {
            return Error{ErrorKind::File,
                         "row " + std::to_string(&row - numbers.rows.data() + 1) + ": alpha is " +
                             shortest(in[*alpha]) + ", wanted above 0"};
        }
        const std::vector<NumericErrors> errors = errorsOf(table, in, picked(row, *outputs));
        for (std::size_t i = 0; i < columns.size(); ++i) {
            columns[i].worst.take(errors[i]);
            if (alpha) columns[i].byDecade[decadeOf(in[*alpha])].take(errors[i]);
        }
    }
    return columns;
}

}  // namespace

void NumericErrors::take(const NumericErrors& other) {
    inFloat = std::max(inFloat, other.inFloat);
    inDouble = std::max(inDouble, other.inDouble);
    fromDirections = std::max(fromDirections, other.fromDirections);
}

std::vector<NumericErrors> errorsOf(const ReferenceTable& table,
                                    const std::vector<double>& row,
                                    const std::vector<double>& reference) {
    const std::size_t count = table.outputs.size();
    std::vector<double> exact(count);
    std::vector<float> narrow(count);
    std::vector<double> moved(count);
    table.inDouble(row, exact);
    table.inFloat(row, narrow);
    if (table.directions) table.fromFloat(row, moved);
    std::vector<NumericErrors> errors(count);
    for (std::size_t i = 0; i < count; ++i) {
        errors[i].inDouble = errorIn<double>(exact[i], reference[i]);
        const double target = table.directions ? moved[i] : reference[i];
        errors[i].inFloat = errorIn<float>(static_cast<double>(narrow[i]), target);
        if (table.directions) errors[i].fromDirections = errorIn<float>(moved[i], reference[i]);
    }
    return errors;
}

Result<AccuracyReport> measureAccuracy(const std::filesystem::path& folder) {
    std::error_code failed;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
        if (entry.path().extension() == ".csv") files.push_back(entry.path());
    }
    if (failed) {
        return Error{ErrorKind::File, "'" + folder.string() + "': " + failed.message()};
    }
    std::sort(files.begin(), files.end());
    AccuracyReport report;
    for (const std::filesystem::path& file : files) {
        const std::vector<ReferenceTable>& tables = referenceTables();
        const auto table = std::find_if(tables.begin(), tables.end(), [&](const ReferenceTable& t) {
            return t.name == file.stem().string();
        });
        if (table == tables.end()) {
            report.skipped.push_back(file.filename().string());
            continue;
        }
        const Result<NumberTable> numbers = readNumberTable(file);
        if (!numbers) return numbers.error();
        auto columns = accuracyOf(*table, *numbers);
        if (!columns) return columns.error().in("'" + file.string() + "'");
        report.columns.insert(report.columns.end(), columns->begin(), columns->end());
    }
    if (report.columns.empty()) {
        return Error{ErrorKind::File,
                     "'" + folder.string() +
                         "': no reference table is there (wanted d_ggx.csv and "
                         "the like, as in tests/reference)"};
    }
    return report;
}

}  // namespace gonio::proc
