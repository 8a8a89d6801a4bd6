#pragma once
// What every plot is asked for, and the words they share.

#include <span>
#include <string>
#include <vector>

#include "proc/core/scatterer.h"

namespace gonio::proc {

struct PlotRequest {
    std::string title;
    std::vector<Radians> incidences;   ///< light at phi = 0
    std::string quantity = "f, 1/sr";  ///< what a hemisphere map shows, over its scale
    /// A hemisphere map's pixels as a picture within: smaller where there is noise, and printed as
    /// they are. Else as runs of one colour, which every program that draws can take apart.
    bool embedded = false;
};

/// The bands that differ: all three, or one of what is monochrome.
[[nodiscard]] std::span<const Band> shownBands(const Scatterer& scatterer);
/// "G 525 nm".
[[nodiscard]] std::string bandName(Band band);
/// The same; "monochrome" where one band stands for all.
[[nodiscard]] std::string bandLabel(const Scatterer& scatterer, Band band);
/// "22.5 deg", "40 deg": to a tenth of a degree.
[[nodiscard]] std::string degreesLabel(Radians angle);

}  // namespace gonio::proc
