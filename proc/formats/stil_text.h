#pragma once
// The "LightTools" text that STIL's Reflet software exports from an RT-300S: one section per scan
// of one incidence, each with a header of its own ("Theta Lighting", "Theta measure beginning",
// ...), then one row per theta of the detector with one value per phi. Fields are separated by
// tabs, lines end in bare CR.
//
// Theta of the detector is signed: a negative one lies beyond the normal, at phi + 180. The file
// does not say where the light is; on this instrument the plane of incidence is phi +-90 and the
// shadow of the light's arm falls on phi 90, so that the mirror direction is 270. A direction that
// one scan meets more than once has the mean of what is not 0; an incidence that was scanned more
// than once gives one channel per scan. Zeros and negative values are what the instrument writes
// without a signal: they are read, and counted in the warnings.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// The text has a line "Data file type" among its first ones, as each of these exports does.
[[nodiscard]] bool isStilText(std::string_view text);

inline constexpr double kStilMirrorDeg = 270;

/// What stands in the header beside angles becomes comments, the sample's name metadata. Errors:
/// "stil: NAME: line 12: ...".
[[nodiscard]] Result<FileRead<SphericalTable>> parseStilText(std::string_view text,
                                                             std::string_view name);

}  // namespace gonio::proc
