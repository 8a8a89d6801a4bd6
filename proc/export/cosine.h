#pragma once
// --cosine: whether a file's values are f cos(theta_o), where the file does not say so or says it
// wrongly. Such data taken for a BRDF is the commonest mistake of all.

#include "proc/core/result.h"
#include "proc/formats/brdf_file.h"

namespace gonio::proc {

/// Values at views closer to the horizon than this are not divided: there is no value then.
inline constexpr double kCosineFloor = 0.01;

/// The file's values as f, `holds` saying what they are. A reader has divided already where the
/// file says that they hold the cosine (Metadata key "cosine"): then `holds` = false undoes it, and
/// `holds` = true leaves all as it is. Counts of what is lost go into the warnings. Usage error for
/// a sample and for formats that state one or the other for good (MERL, RGL, UTIA, .mbsdf, Klems).
[[nodiscard]] Result<BrdfFile> withCosineTold(BrdfFile file, bool holds);

}  // namespace gonio::proc
