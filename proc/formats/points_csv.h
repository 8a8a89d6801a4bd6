#pragma once
// Pairs of directions as CSV, and answers beside them. The header names the columns: either
// theta_i,phi_i,theta_o,phi_o in degrees (theta in [0, 180]; 90 and more is below the horizon), or
// the vectors wi_x,wi_y,wi_z,wo_x,wo_y,wo_z of any length but 0, normalised exactly. The columns
// may stand in any order among others; others are carried along as they are. Empty lines and lines
// that start with # are skipped. A field may stand in double quotes; a quoted field ends on its
// line.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

struct Points {
    std::vector<std::string> columns;  ///< names, as in the header
    std::vector<std::string> rows;     ///< the lines as read, without their end
    std::vector<LightView> pairs;      ///< one per row
};

/// `name` stands in errors: "csv: NAME: line 3: theta_i: 'banana', wanted a number".
[[nodiscard]] Result<Points> parsePoints(std::string_view text, std::string_view name);
[[nodiscard]] Result<Points> readPoints(const std::filesystem::path& path);

/// The numbers of the column `column`, one per row; NaN where a field is empty or says nan. A File
/// error for a column that is not there, or a field that is no number.
[[nodiscard]] Result<std::vector<double>> numbersOf(const Points& points, std::string_view column);

/// The input columns, then f_r,f_g,f_b (BandCount::One: f), u_r,u_g,u_b (u) where any answer knows
/// it, flags (the decimal mask) and source. Empty where missing; shortest digits. An input column
/// of one of these names is kept as input_NAME. One answer per row.
[[nodiscard]] std::string evalCsv(const Points& points,
                                  std::span<const Answer> answers,
                                  BandCount bands);

}  // namespace gonio::proc
