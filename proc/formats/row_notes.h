#pragma once
// What a format for lists of directions has no column for, but free text: kept in two lines among
// the metadata, which are there only where the columns alone would tell another.
//
//  - symmetry: isotropic or none. Without it, lights of one azimuth are of an isotropic sample.
//  - wavelengths_nm: of the channels in their order, where their names alone stand in the file.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/loss_report.h"
#include "proc/table/brdf_rows.h"
#include "proc/table/metadata.h"

namespace gonio::proc {

/// `about` with the notes of these rows. `namesHideWavelengths`: the file does not have those of
/// its channels elsewhere.
[[nodiscard]] Metadata withRowNotes(Metadata about,
                                    const BrdfRows& rows,
                                    bool namesHideWavelengths);

/// Takes the notes out of `about` and makes them true of rows that were read.
void takeRowNotes(Metadata& about, BrdfRows& rows);

/// What a format of values alone drops: uncertainties, and flags that say more than measured.
void countDroppedColumns(const BrdfRows& rows, LossReport& loss);

/// Usage error for rows of which a writer keeps none: "astm: no direction has a value in every
/// channel". A file without rows is none to its own reader.
[[nodiscard]] Error noWholeRow(std::string_view format);

/// "3 negative values"; nothing where there are none.
[[nodiscard]] std::vector<std::string> negativeValues(const BrdfRows& rows);

}  // namespace gonio::proc
