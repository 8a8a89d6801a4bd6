#pragma once
// The rows of a CSV whose header names two directions: either theta_i,phi_i,theta_o,phi_o in
// degrees (theta in [0, 180]; 90 and more is below the horizon), or the vectors
// wi_x,wi_y,wi_z,wo_x,wo_y,wo_z of any length but 0, normalised exactly. The columns may stand in
// any order among others. Empty lines are skipped, and lines that start with #, which are comments.
// A field may stand in double quotes; a quoted field ends on its line.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/direction.h"
#include "proc/core/result.h"
#include "proc/formats/text_lines.h"

namespace gonio::proc {

/// Of one line, without their quotes; commas inside double quotes do not separate; at most one
/// more than a header may have. `reuse` is room from the last line.
[[nodiscard]] std::vector<std::string_view> csvFields(std::string_view line,
                                                      std::vector<std::string_view> reuse = {});

/// A column's name as a field: in quotes where it needs them.
[[nodiscard]] std::string csvName(const std::string& name);

class CsvRows {
public:
    /// `name` stands in errors: "csv: NAME: line 3: theta_i: 'banana', wanted a number".
    CsvRows(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    /// On to the next row, the header before the first one; false at the end, and where there is an
    /// error.
    bool next();
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

    /// Names, as in the header.
    [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
    [[nodiscard]] std::string_view line() const { return line_; }
    /// As many as columns.
    [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
    [[nodiscard]] const LightView& pair() const { return pair_; }
    /// Without #, and without one blank behind it; of what was passed so far.
    [[nodiscard]] const std::vector<std::string>& comments() const { return comments_; }

    /// Sets the error of the line under way; false.
    bool fail(const std::string& what);
    /// The number in a column; NaN where the field is empty or says nan. Empty, with an error, for
    /// anything else.
    [[nodiscard]] std::optional<double> number(std::size_t column);

private:
    /// The next line that says something.
    std::optional<std::string_view> nextLine();
    bool quotesEnd(std::string_view line);
    bool header(std::string_view line);
    bool row(std::string_view line);
    bool fromAngles();
    bool fromVectors();

    TextLines lines_;
    std::string_view name_;
    std::vector<std::string> columns_;
    std::vector<std::size_t> places_;  ///< columns of the directions, in the order of their names
    bool vectors_ = false;
    std::string_view line_;
    std::vector<std::string_view> fields_;
    std::array<double, 6> numbers_{};
    LightView pair_;
    std::vector<std::string> comments_;
    std::optional<Error> error_;
};

}  // namespace gonio::proc
