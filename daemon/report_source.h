#pragma once
// What a sample report is made from: a .gonio file, or a sample of the store with the calibrations
// that the store has of it and the operator of its session.

#include <filesystem>
#include <string>

#include "daemon/material.h"
#include "proc/report/report_origin.h"

namespace gonio::daemon {

struct ReportSource {
    Material material;          ///< a measured sample
    proc::ReportOrigin origin;  ///< without the report's own date and program
};

/// Usage error for what is no measured sample; else errors as openMaterial.
[[nodiscard]] Result<ReportSource> openForReport(const std::string& f,
                                                 const std::filesystem::path& store);

}  // namespace gonio::daemon
