#pragma once
// Zemax tabular BSDF (.bsdf, ASCII), as FORMATS.md 1 describes it. Lenient about the form: keyword
// case and order, any white space and line ends, comments anywhere, lists over several lines, the
// spelling ASymmetrical. Strict about numbers: each must be finite and complete, axes ascend, and
// the counts of the header are held against the size of the text before anything is allocated.
//
// The rows of one incidence share the value at radial 0; where they differ, reading takes their
// mean. TIS is kept as written, never believed. XYZ stays XYZ. Comments are kept.

#include <filesystem>
#include <string>
#include <string_view>

#include "proc/core/bands.h"
#include "proc/core/result.h"
#include "proc/formats/loss_report.h"
#include "proc/table/specular_table.h"

namespace gonio::proc {

/// `name` stands in errors: "zemax: NAME: line 212: 35 values in block, header promised 36".
[[nodiscard]] Result<SpecularTable> parseZemax(std::string_view text, std::string_view name);
[[nodiscard]] Result<SpecularTable> readZemax(const std::filesystem::path& path);

/// Not of LedBands, which the format has no place for. The planes must have the sizes of the
/// axes. Shortest digits that read back to the same double,
/// so that write-read-write gives the same bytes. A TIS that is not known is written as the
/// integral of the values. What is not finite is written as 0, as the format wants, and counted.
[[nodiscard]] Written writeZemax(const SpecularTable& table);

/// The comment in which the format's missing wavelength stands: "Wavelength (nm) = 525".
[[nodiscard]] std::string wavelengthComment(double nanometres);

}  // namespace gonio::proc
