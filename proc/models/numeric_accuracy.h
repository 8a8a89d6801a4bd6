#pragma once
// How far the kernels are from tables of reference values, in float and in double.
//
// The error of a value is relative where the reference is a normal number of the tested type (above
// 1.2e-38 in float, 2.3e-308 in double), else the distance from it in units of that limit, which is
// 0 for what rounds to it. In tables of directions the float column is the arithmetic's own,
// against double from the same narrowed directions; what narrowing costs (about 1e-6 / alpha)
// stands apart.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "proc/core/result.h"
#include "proc/models/reference_tables.h"

namespace gonio::proc {

struct NumericErrors {
    double inFloat = 0;
    double inDouble = 0;
    double fromDirections = 0;  ///< 0 in tables without directions

    void take(const NumericErrors& other);
};

struct ColumnAccuracy {
    std::string table;
    std::string column;
    bool directions = false;
    std::size_t rows = 0;
    NumericErrors worst;
    std::map<int, NumericErrors> byDecade;  ///< of alpha: -7 is [1e-7, 1e-6); empty without alpha
};

struct AccuracyReport {
    std::vector<ColumnAccuracy> columns;
    std::vector<std::string> skipped;  ///< CSV files of the folder that no kernel here answers for
};

/// One row's errors, by output column; `reference` has the row's outputs.
[[nodiscard]] std::vector<NumericErrors> errorsOf(const ReferenceTable& table,
                                                  const std::vector<double>& row,
                                                  const std::vector<double>& reference);

/// Every table of the folder. A File error names what is malformed, or that no table is there.
[[nodiscard]] Result<AccuracyReport> measureAccuracy(const std::filesystem::path& folder);

}  // namespace gonio::proc
