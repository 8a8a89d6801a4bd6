#pragma once
// ASTM text (.astm), as Cornell's files and the tools that read them have it (FORMATS.md 7): header
// lines KEY VALUE, the last one VARS with the columns' names, then rows of numbers between commas.
// Angles in radians: theta_i,phi_i,theta_s,phi_s, or theta_i,theta_s,phi_s of an isotropic sample;
// theta_s beyond pi/2 is transmission. Other columns are channels: R, G, B; X, Y, Z; 550nm; one of
// any name. Values are f in 1/sr. Keywords in any case, columns' names as they stand.
//
// NUM_POINTS, where it is there, must be the number of rows. A row has a value in every channel.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/brdf_rows.h"

namespace gonio::proc {

/// `name` stands in errors: "astm: NAME: line 12: 6 values, VARS has 7". Keys without one of ours
/// become "astm.KEY".
[[nodiscard]] Result<FileRead<BrdfRows>> parseAstm(std::string_view text, std::string_view name);

/// Radians rounded to 1e-12. A pair that lacks a channel is left out, which is counted, as are
/// uncertainties and flags; Usage error where none is left. Metadata without a key of the format
/// stand behind COMMENT.
[[nodiscard]] Result<Written> writeAstm(const BrdfRows& rows, const Metadata& about);

}  // namespace gonio::proc
