#pragma once
// What `gonio merge` is given: measured samples, and files of one band each.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proc/core/bands.h"
#include "proc/table/sample_set.h"
#include "proc/table/scattered_set.h"

namespace gonio::daemon {

/// One F: a measured sample, or else the values of one band.
struct MergeInput {
    std::string file;  ///< as it was named
    std::optional<proc::SampleSet> sample{};
    std::optional<proc::ScatteredSet> values{};
    std::optional<Band> band{};  ///< the only one, where there is only one
};

/// Reads them; of a CSV the column f, where there u_random (or u), u_systematic and flags, without
/// the rows that are saturated, blocked or below the horizon. A file that holds the same values as
/// one before it counts once, with a warning in the log. A File error for a file that is none; a
/// Usage error for a model, for a file of three bands that is no sample, and where the band of a
/// file is not known: that is what its comment `Wavelength (nm) = ...` says, else a word R, G, B,
/// red, green or blue of its name.
[[nodiscard]] Result<std::vector<MergeInput>> readMergeInputs(const std::vector<std::string>& files,
                                                              const std::filesystem::path& store);

}  // namespace gonio::daemon
