#pragma once
// LightTools BSDF (.bsdf, ASCII), as FORMATS.md 2 describes it and MiniDiff exports it: blocks of
// one incidence, one plane of incidence, one side, one wavelength or tristimulus value, reflection
// or transmission, all on the azimuths and radial angles of the header. Angles are counted from the
// normal: radial 0..90, in transmission from the normal of the far side. The light stands at
// azimuth 90, its mirror direction at 270.
//
// Lenient about form (case, order within header and block, white space, comments, line ends),
// strict about numbers. What is checked and said in the warnings: peaks that do not lie at the
// mirror direction, negative values, incidence from behind (Side Back, or AOI beyond 90, which is
// 180 - AOI): such blocks are left out, and read only where the file has no others.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// Where the plane of incidence lies in LightTools files: the light, and its mirror direction.
inline constexpr double kLightToolsLightDeg = 90;
inline constexpr double kLightToolsMirrorDeg = 270;

/// Metadata key: "back" where the table is of light from behind.
inline constexpr std::string_view kLightToolsSide = "side";

/// MiniDiff measures to here; its exports go on to 90 with numbers that the vendor extrapolates.
inline constexpr double kMiniDiffReachDeg = 75;

enum class VendorExtrapolation {
    Masked,
    Kept
};

/// A file of the MiniDiff layout (24 blocks: 3 wavelengths, 4 incidences, BRDF and BTDF, each on
/// 361 azimuths 0..360 and 91 radials 0..90) loses its values beyond kMiniDiffReachDeg, with a
/// warning that counts them, unless they are asked for. `name` stands in errors: "lighttools: NAME:
/// line 12: 35 values in block, header promised 36".
[[nodiscard]] Result<FileRead<SphericalTable>> parseLightTools(
    std::string_view text,
    std::string_view name,
    VendorExtrapolation beyond = VendorExtrapolation::Masked);

/// One header for all blocks: those on other axes than the first are dropped, as are channels that
/// neither a wavelength nor X, Y, Z tells apart. What has no data is written as 0. A TIS that is
/// not known is the integral of the block. All metadata become comments.
[[nodiscard]] Written writeLightTools(const SphericalTable& table, const Metadata& about);

}  // namespace gonio::proc
