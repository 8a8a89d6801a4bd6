#pragma once
// UTIA's anisotropic BRDFs [Filip2014]: raw little-endian doubles without a header, 3 planes of
// theta_i 0..75 by 15 degrees, phi_i 0..352.5 by 7.5, theta_v and phi_v likewise (fastest);
// 1 990 656 bytes in all, which is the only mark of the format. The same numbers also stand in an
// OpenEXR picture of 288 x 288 pixels, row (theta_i, phi_i), column (theta_v, phi_v).
//
// The scale is disputed: one reader takes the numbers for f in 1/sr, another (dj_brdf) for a
// gamma-coded 140th of it. Raw is the default, and a warning says so. Negative values occur and are
// kept. Azimuths are taken counter-clockwise seen from above in the sample's frame.
//
// In the table a block is one light direction and channel, mirrorAzimuthDeg 180: azimuth =
// phi_v - phi_i.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

enum class UtiaScale {
    Raw,     ///< the number is f
    DjBrdf,  ///< 100 times the sRGB decoding (straight below 0.0375) of a 140th of the number
};

/// `name` stands in errors: "utia: NAME: 100 bytes, wanted 1990656".
[[nodiscard]] Result<FileRead<SphericalTable>> parseUtia(std::string_view bytes,
                                                         std::string_view name,
                                                         UtiaScale scale = UtiaScale::Raw);

/// The EXR variant: channels R, G, B.
[[nodiscard]] Result<FileRead<SphericalTable>> parseUtiaExr(std::string_view bytes,
                                                            std::string_view name,
                                                            UtiaScale scale = UtiaScale::Raw);

/// Raw numbers. Usage error unless the table has the channels R, G, B and the format's axes
/// (utiaGrid). NaN is written as 0, the format has no other way, and counted.
[[nodiscard]] Result<Written> writeUtia(const SphericalTable& table, const Metadata& about = {});

/// A table of the format's channels and directions, all NaN: to be filled and written.
[[nodiscard]] SphericalTable utiaGrid();

}  // namespace gonio::proc
