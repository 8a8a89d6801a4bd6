#pragma once
// The kernels behind the columns of the 60-digit reference tables (tests/reference), in float and
// in double: the same code as models evaluate, one table row at a time. Directions of a row are
// unit to float rounding only: they are normalised in double, then narrowed.

#include <span>
#include <string_view>
#include <vector>

namespace gonio::proc {

struct ReferenceTable {
    std::string_view name;                  ///< of the file, without .csv
    std::vector<std::string_view> inputs;   ///< its first columns
    std::vector<std::string_view> outputs;  ///< the columns after them; what is left is not ours
    /// Whether rows hold directions, which narrowing to float moves by up to 6e-8.
    bool directions = false;

    using InDouble = void (*)(std::span<const double> in, std::span<double> out);
    using InFloat = void (*)(std::span<const double> in, std::span<float> out);
    InDouble inDouble = nullptr;
    InFloat inFloat = nullptr;
    /// In double from inputs narrowed to float: what the narrowing alone costs.
    InDouble fromFloat = nullptr;
};

[[nodiscard]] const std::vector<ReferenceTable>& referenceTables();

}  // namespace gonio::proc
