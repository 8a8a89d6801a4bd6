#pragma once
// Writing what a conversion made, and telling what each file lost.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "daemon/cli/commands.h"
#include "proc/export/conversion.h"

namespace gonio::daemon {

/// STEM.EXT, or STEM_R.EXT ... where a format takes several; each replaces a file of that name as a
/// whole. A line on stderr for each loss, and an entry of `files` for each file.
Result<void> writeConverted(const CommonOptions& common,
                            const std::vector<proc::ConvertedFile>& converted,
                            const std::filesystem::path& output,
                            nlohmann::ordered_json& files);

/// "resampled: 117652 values asked at the format's directions, largest error 1.2 %, weighted 0.1 %"
[[nodiscard]] std::string lossText(const proc::LossReport::Item& item);

}  // namespace gonio::daemon
