#pragma once
// MERL tables (.binary) [Matusik2003]: three little-endian 32-bit counts (90, 90, 180), then R, G
// and B as doubles, which times 1/1500, 1.15/1500 and 1.66/1500 are f in 1/sr. Nothing else: no
// text, no wavelength, no uncertainty. Values are taken at the lower edges of their cells, as the
// reference code's truncation leaves it open. A negative value says that there is none.
//
// The counts may be others than MERL's; 360 of phi_diff are the whole circle. A NaN or an infinite
// value is refused. The known extra factor 2 of some renderers is none of the format's.

#include <array>
#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/half_difference_table.h"

namespace gonio::proc {

/// Stored number times this is f in 1/sr.
inline constexpr std::array<double, 3> kMerlScale{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

/// `name` stands in errors: "merl: NAME: 100 bytes, 90 x 90 x 180 want 34992012".
[[nodiscard]] Result<FileRead<HalfDifferenceTable>> parseMerl(std::string_view bytes,
                                                              std::string_view name);

/// The planes must have the sizes of the axes. -1 where there is no data, counted; so are negative
/// values, which the format has no place for. What is read back is f to the last bit or the one
/// before it, and written again gives the same bytes.
[[nodiscard]] Written writeMerl(const HalfDifferenceTable& table, const Metadata& about = {});

}  // namespace gonio::proc
