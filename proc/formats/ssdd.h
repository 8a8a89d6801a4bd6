#pragma once
// SSDD 0.1 to 0.3 (.ssdd), libbsdf's own format [S]: a text header, then up to four blocks of
// metadata and a grid, as text or as little-endian float32. One colour per grid point, the grid in
// the order PARAM3 (outermost), 2, 1, 0.
//
// spherical_coordinate_system becomes a SphericalTable: incoming theta and phi, outgoing theta and
// phi, all in the sample's frame; in a btdf the outgoing theta is counted from the far side's
// normal. Isotropic data have the light at phi 0. specular_coordinate_system becomes a
// SpecularTable, whose coordinates are the same: for one kind, monochrome or XYZ, without offsets.
// The other parameter types are refused by name. specular_reflectance and _transmittance are left
// out with a warning.

#include <cstdint>
#include <string_view>
#include <variant>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/specular_table.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

using SsddTable = std::variant<SphericalTable, SpecularTable>;

/// Incidence 90 and a repeated azimuth of 360 are left out, with a warning. Errors: "ssdd: NAME:
/// line 12: ...".
[[nodiscard]] Result<FileRead<SsddTable>> parseSsdd(std::string_view bytes, std::string_view name);

enum class SsddData : std::uint8_t {
    Ascii,
    Binary
};

/// One grid per kind: blocks on other axes than the first of their kind are dropped, what is
/// missing is written as 0. Channels by wavelength are a spectrum; X, Y, Z or R, G, B without
/// wavelengths, and one channel, have colour models of their own. Usage error for any others. All
/// metadata become comments; sample, rig, software and date also have their fields. Binary values
/// are rounded to single precision, and the report says by how much.
[[nodiscard]] Result<Written> writeSsdd(const SphericalTable& table,
                                        const Metadata& about,
                                        SsddData data = SsddData::Ascii);

}  // namespace gonio::proc
