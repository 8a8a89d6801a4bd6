#pragma once
// NVIDIA's measured BSDFs for MDL (.mbsdf, version 1): a line "NVIDIA ARC MBSDF V1", lines
// key="value" (escapes \n, \\, \"), then a block of reflection and, if there is one, of
// transmission: little-endian 32-bit type (0 one value, 1 R, G, B), number of polar angles,
// number of azimuths, and the values as floats, theta_in > theta_out > azimuth > channel (fastest).
//
// Values stand at the centres of even cells: theta over [0, 90), the azimuth between light and view
// over [0, 180]; 0 is the light's own side, 180 the mirror's. In transmission theta_out counts from
// the lower normal. In the table: mirrorAzimuthDeg 180, plane-symmetrical. A NaN, an infinite value
// and a duplicated key are refused. A block "MBSDF_DATA=" is reflection.
//
// No such file was at hand: what is read is what the specification says, and what is written.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// `name` stands in errors: "mbsdf: NAME: byte 120: ...".
[[nodiscard]] Result<FileRead<SphericalTable>> parseMbsdf(std::string_view bytes,
                                                          std::string_view name);

/// Usage error unless the table is one of mbsdfGrid()'s: one channel, or R, G, B. Missing values
/// are written as 0, the format has no other way, and counted; so is what lies beyond a float.
/// Metadata become keys, comments keys "comment".
[[nodiscard]] Result<Written> writeMbsdf(const SphericalTable& table, const Metadata& about = {});

struct MbsdfShape {
    std::size_t thetas = 90, azimuths = 180;
};

/// Blocks of the format's directions, all NaN, incidence > channel: to be filled and written.
[[nodiscard]] SphericalTable mbsdfGrid(std::vector<Channel> channels,
                                       MbsdfShape reflection,
                                       std::optional<MbsdfShape> transmission = std::nullopt);

}  // namespace gonio::proc
