#pragma once
// A CSV of numbers under one line of names, as tables of reference values and of normals are.

#include <filesystem>
#include <string>
#include <vector>

#include "proc/core/result.h"

namespace gonio {

struct NumberTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> rows;  ///< each as long as `names`
};

/// A File error names the file, the line and what was wanted: a name per column, a finite number in
/// every cell, at most 100,000 rows. Empty lines are passed over.
[[nodiscard]] Result<NumberTable> readNumberTable(const std::filesystem::path& file);

}  // namespace gonio
