#pragma once
// BiRD universal BRDF data format, JSON schema v1.0 (.brdf, .json; FORMATS.md 6), streamed both
// ways: one entry for each direction pair and channel. theta_r of 90 degrees and more is read as
// transmission; the schema has no place for it, so that it is not written.
//
// uBRDF is the combined standard uncertainty (k = 1; the schema does not say, the comments of the
// variable do). What the schema has no place for stands in adhoc variables of the same length:
// u_random, u_systematic, flags (decimal masks), channel (names), and negative: BRDF must not be
// below 0, so that a negative value is 0 there and itself here. The two layouts before v1.0, with
// data.variables and data.values, are read only.
//
// Of what the schema's metadata hold, the sample's name, its symmetry, the time, the software, the
// rig and the solid angle have their keys (proc/table/metadata.h); all else is kept as "bird.PATH",
// and our own in the comments.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/brdf_rows.h"

namespace gonio::proc {

/// `name` stands in errors: "bird: NAME: line 212: theta_r: 12 values, BRDF has 13".
[[nodiscard]] Result<FileRead<BrdfRows>> parseBird(std::string_view text, std::string_view name);

/// Angles in degrees, rounded to 1e-9. Left out and counted: missing values, and theta of 90
/// degrees and more. Usage error where nothing is left: such a file is none to its own reader.
[[nodiscard]] Result<Written> writeBird(const BrdfRows& rows, const Metadata& about);

}  // namespace gonio::proc
