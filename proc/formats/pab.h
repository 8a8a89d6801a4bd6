#pragma once
// pab-opto "Mountain" text, as Radiance's pabopto2bsdf reads it (FORMATS.md 11): one file for one
// direction of the light. Header lines #KEYWORD VALUE, then rows theta phi VALUE(S) in degrees and
// in any order, theta beyond 90 being the other side of the surface. #format says what the values
// are: BSDF, BRDF and BTDF are f in 1/sr; DSF is f cos(theta_o), which is divided by it and leaves
// no value at the horizon. Three values are X, Y, Z (#colorimetry: CIE-XYZ), one is a channel that
// the format does not name.
//
// #upphi, which only says how the sample hung, is kept as "pab.upphi".

#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/brdf_rows.h"

namespace gonio::proc {

/// `name` stands in errors: "pab: NAME: line 12: 2 numbers, wanted theta, phi and 1 value".
[[nodiscard]] Result<FileRead<BrdfRows>> parsePab(std::string_view text, std::string_view name);

struct PabFile {
    /// "_t020p000" (theta and phi of the light), then "_back" for transmission, then the channel
    /// "_r", where there are several.
    std::string suffix;
    std::string bytes;
};
struct WrittenPab {
    std::vector<PabFile> files;
    LossReport loss;
};

/// A file for each light, side of the surface and channel (X, Y, Z together). Angles rounded to
/// 1e-9 degrees. Values that are missing are left out; uncertainties and flags have no place.
/// Usage error where no value is left, and for more lights than kMostPabLights: a list of scattered
/// pairs is not what the format is for.
[[nodiscard]] Result<WrittenPab> writePab(const BrdfRows& rows, const Metadata& about);

/// As many as Radiance reads.
inline constexpr std::size_t kMostPabLights = 512;

}  // namespace gonio::proc
