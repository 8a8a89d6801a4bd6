#pragma once
// What a surface becomes outside: native, Zemax BSDF (one file for each band), CSV; each with what
// was lost on the way.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/material.h"
#include "proc/core/bands.h"
#include "proc/core/result.h"
#include "proc/formats/loss_report.h"

namespace gonio::daemon {

enum class ExportFormat {
    Gonio,
    Zemax,
    Csv
};
[[nodiscard]] std::string_view name(ExportFormat format);
/// ".gonio", ".bsdf", ".csv".
[[nodiscard]] std::string_view extension(ExportFormat format);
/// "gonio", "zemax" or "csv"; anything else is a Usage error that lists them.
[[nodiscard]] Result<ExportFormat> parseExportFormat(std::string_view text);
/// By a file's extension, where it tells.
[[nodiscard]] std::optional<ExportFormat> formatOfExtension(std::string_view extension);

struct ExportedFile {
    std::string suffix;  ///< of the file's stem: "_G" for one band of several, else empty
    std::string bytes;
    proc::LossReport loss;
};

/// One file, or one for each band; `only` one of them. Usage error for a format that this surface
/// cannot become: only a measured sample becomes .gonio or CSV.
[[nodiscard]] Result<std::vector<ExportedFile>> exportAs(const Material& surface,
                                                         ExportFormat format,
                                                         std::optional<Band> only = {});
/// Zemax, its nodes answered by an estimator of the surface.
[[nodiscard]] std::vector<ExportedFile> exportFilled(const Material& surface,
                                                     const Scatterer& estimator);

}  // namespace gonio::daemon
