#pragma once
// What the conversions to single formats share: the view of one band, the grid that is asked, the
// error of what was asked anew, and what any grid of plain values loses.

#include <memory>
#include <optional>
#include <vector>

#include "proc/export/conversion.h"

namespace gonio::proc {

using Converted = Result<std::vector<ConvertedFile>>;

/// What a writer made, as the only file.
[[nodiscard]] ConvertedFile fileOf(Written written);
[[nodiscard]] Converted onlyFile(Result<Written> written);

/// Nothing keeps the source's own table from being written as it is.
[[nodiscard]] bool mayCopy(const ConversionSource& source, const ConversionWish& wish);

/// That a table is asked at.
[[nodiscard]] std::vector<double> incidencesFor(const ConversionSource& source,
                                                const ConversionWish& wish);

/// The source's one band, or the one that is named of several, as a monochrome surface.
[[nodiscard]] std::shared_ptr<const Scatterer> bandOf(const ConversionSource& source, Band band);
/// All bands, or the one value.
[[nodiscard]] std::shared_ptr<const Scatterer> allBands(const ConversionSource& source);
/// R, G, B; or the one channel of a monochrome source.
[[nodiscard]] std::vector<Channel> channelsFor(const ConversionSource& source);

/// Usage error where nothing answers between the source's values.
[[nodiscard]] Result<void> mustAnswer(const ConversionSource& source, Format to);
/// Likewise where it has two of the three bands that the format wants.
[[nodiscard]] Result<void> mustHaveThree(const ConversionSource& source, Format to);

/// Uncertainties, flags and transmission of the source, which a grid of plain values leaves out.
void addPlainLosses(LossReport& loss, const ConversionSource& source);
/// Of these, what no look-up of the source answers: transmission, and other faces and spectra.
void addSideLosses(LossReport& loss, const ConversionSource& source);

/// What was asked anew: `nodes` above the horizon, of which some without an answer and some from
/// beyond what was measured.
struct Asked {
    std::size_t nodes = 0, unanswered = 0, extrapolated = 0;
};
/// The written file read back as `to`, against the source; `band`: it holds that one alone.
void addResampling(ConvertedFile& file,
                   const ConversionSource& source,
                   const Asked& asked,
                   Format to,
                   std::optional<Band> band = {});

// One function per kind of table.
[[nodiscard]] Converted toGonio(const ConversionSource& source, const ConversionWish& wish);
[[nodiscard]] Converted toRows(const ConversionSource& source, const ConversionWish& wish);
[[nodiscard]] Converted toZemax(const ConversionSource& source, const ConversionWish& wish);
[[nodiscard]] Converted toExrTiles(const ConversionSource& source, const ConversionWish& wish);
[[nodiscard]] Converted toSpherical(const ConversionSource& source, const ConversionWish& wish);
[[nodiscard]] Converted toMerl(const ConversionSource& source, const ConversionWish& wish);
[[nodiscard]] Converted toRgl(const ConversionSource& source, const ConversionWish& wish);

}  // namespace gonio::proc
