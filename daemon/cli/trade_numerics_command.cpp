#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "proc/formats/file_bytes.h"
#include "proc/models/numeric_accuracy.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const proc::ColumnAccuracy& column) {
    Json json{
        {"float", column.worst.inFloat}, {"double", column.worst.inDouble}, {"rows", column.rows}};
    if (column.directions) json["float_directions"] = column.worst.fromDirections;
    for (const auto& [decade, errors] : column.byDecade) {
        json["alpha"]["1e" + std::to_string(decade)] = {{"float", errors.inFloat},
                                                        {"double", errors.inDouble}};
    }
    return json;
}

std::string rounded(double error) {
    std::ostringstream text;
    text << std::setprecision(2) << error;
    return text.str();
}

using Rows = std::vector<std::vector<std::string>>;

Rows worstRows(const proc::AccuracyReport& report) {
    Rows rows{{"table", "column", "rows", "float", "double", "float directions"}};
    for (const proc::ColumnAccuracy& c : report.columns) {
        rows.push_back({c.table,
                        c.column,
                        std::to_string(c.rows),
                        rounded(c.worst.inFloat),
                        rounded(c.worst.inDouble),
                        c.directions ? rounded(c.worst.fromDirections) : ""});
    }
    return rows;
}

Rows decadeRows(const proc::AccuracyReport& report) {
    Rows rows{{"table", "column", "alpha from", "float", "double"}};
    for (const proc::ColumnAccuracy& c : report.columns) {
        for (const auto& [decade, errors] : c.byDecade) {
            rows.push_back({c.table,
                            c.column,
                            "1e" + std::to_string(decade),
                            rounded(errors.inFloat),
                            rounded(errors.inDouble)});
        }
    }
    return rows;
}

}  // namespace

Result<void> tradeNumerics(const CommonOptions& common, const TradeNumericsOptions& options) {
    const Result<proc::AccuracyReport> report = proc::measureAccuracy(options.reference);
    if (!report) return report.error().in("trade numerics");
    if (!options.output.empty()) {
        const std::string text =
            markdownTable(worstRows(*report)) + "\n" + markdownTable(decadeRows(*report));
        if (auto done = proc::writeFile(options.output, text); !done) return done;
    }
    if (common.json) {
        Json tables = Json::object();
        for (const proc::ColumnAccuracy& column : report->columns) {
            tables[column.table][column.column] = toJson(column);
        }
        printJson({{"schema", "gonio/trade-numerics/1"},
                   {"tables", tables},
                   {"skipped", report->skipped}});
        return {};
    }
    printTable(worstRows(*report));
    std::cout << "\n";
    printTable(decadeRows(*report));
    for (const std::string& file : report->skipped) {
        std::cout << "skipped: " << file << ": no kernel answers for it\n";
    }
    return {};
}

}  // namespace gonio::daemon
