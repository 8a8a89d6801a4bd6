#pragma once
// F, read as it is to be converted: from which format, which of its values, with or without the
// cosine, and what answers between them.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proc/core/result.h"
#include "proc/export/band_choice.h"
#include "proc/export/conversion.h"
#include "proc/formats/rt300s_brdf.h"

namespace gonio::daemon {

struct ConversionInput {
    std::string f;                       ///< a file, sample:NAME or model:SPEC
    std::optional<proc::Format> from{};  ///< else by its content
    proc::BandChoice bands{};
    std::optional<bool> cosine{};    ///< whether its values hold it; else as the file says
    std::string estimator = "none";  ///< else it answers all directions of a table
    /// RT-300S readings: those of the empty stage, and more of the same sample, to be averaged.
    std::filesystem::path black{};
    std::vector<std::filesystem::path> repeats{};
    proc::Rt300sOptions readings{};
};

struct OpenedConversion {
    proc::ConversionSource source;
    std::string title;  ///< the sample's own name, the model, or the file's
    std::vector<std::string> warnings;
};

[[nodiscard]] Result<OpenedConversion> openConversion(const ConversionInput& input,
                                                      const std::filesystem::path& store);

}  // namespace gonio::daemon
