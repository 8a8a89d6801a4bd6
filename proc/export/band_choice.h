#pragma once
// --bands: which of a file's values are converted, and as what.
//   r,g,b or some of them   these bands; of a file of one value: the band that it is
//   2                       the file's second channel alone, as a file of one value
//   g=2                     the same, as the band that it is
//   srgb                    X, Y, Z as linear sRGB
// A file of wavelengths gives the bands by neighbouring ones (band_channels.h).

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/result.h"
#include "proc/formats/brdf_file.h"

namespace gonio::proc {

struct BandChoice {
    std::vector<Band> bands;  ///< empty: those of the file
    bool srgb = false;
    std::optional<std::size_t> channel{};  ///< from 1; beside it at most one band
};

[[nodiscard]] Result<BandChoice> parseBandChoice(std::string_view text);

/// The file with these values alone. Usage error for a choice that it cannot meet.
[[nodiscard]] Result<BrdfFile> chosen(BrdfFile file, const BandChoice& choice);

/// Bands of the file, once chosen: R, G, B or those that a sample has; the one of one value, or
/// none where it is not known. Usage error for tristimulus values and for wavelengths that are none
/// of the bands.
[[nodiscard]] Result<std::vector<Band>> bandsOf(const BrdfFile& file);

}  // namespace gonio::proc
