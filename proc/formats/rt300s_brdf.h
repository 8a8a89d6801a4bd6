#pragma once
// RT-300S readings as BRDF. With S the sample's reading and B that of the empty stage (black) at
// the same angles,
//     f = (S - B) / (pi cos(receive)).
// Black is matched by angle, never by row: scans have different lengths.
//
// Geometry: receive > 0 views along azimuth A + 270 from the light, receive < 0 along A + 90, so
// that the plane of incidence is A = +-90 and the mirror direction is receive = incidence at A =
// -90 and receive = -incidence at A = +90. Which way the azimuth turns is not said anywhere; here A
// grows counter-clockwise seen from above. At receive 0 all azimuths are the normal: their mean.
//
// Where the arm of the light stands before the detector, at the light's own direction, the
// instrument reads no light: such nodes are masked. What remains there after the subtraction tells
// whether black is of the same state of the instrument as the sample.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/formats/rt300s.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

struct Rt300sOptions {
    /// Both sides of the plane of incidence are averaged, as the laboratory does: azimuths 0..180.
    bool planeSymmetrical = false;
    /// The mean that is left in the arm's shadow at each incidence is taken off, too: for a black
    /// of another state of the instrument.
    bool zeroAtShadow = false;
};

struct Rt300sBrdf {
    /// One channel without a name; blocks by incidence, the light at azimuth 0, the mirror at 180.
    SphericalTable table;
    std::size_t unmatched = 0;  ///< readings of samples without one of black
    std::size_t shadowed = 0;   ///< readings in the arm's shadow
    std::size_t negative = 0;   ///< nodes with f < 0: kept
    /// Mean of S - B in the shadow, before zeroAtShadow; NaN without such readings.
    double shadowNet = 0;
    /// Standard deviation of black's readings.
    double blackDeviation = 0;
};

/// Mean of several samples (rotations, repeats), node by node over those that have it; at least
/// one. File error where no reading has a black one at its angles.
[[nodiscard]] Result<Rt300sBrdf> rt300sBrdf(std::span<const Rt300sScan> samples,
                                            const Rt300sScan& black,
                                            const Rt300sOptions& options = {});

/// Sentences for whoever uses it: what was left out, and a black that does not fit.
[[nodiscard]] std::vector<std::string> warningsOf(const Rt300sBrdf& made);

/// What a JDV export holds: values that the instrument calls BRDF, as they stand; the shadow is
/// masked. Each time an incidence comes again is one more channel.
[[nodiscard]] SphericalTable tableOfJdv(std::span<const JdvBlock> blocks);

/// A file that is a BRDF by itself: a JDV export. A Usage error for raw readings, which are none
/// without black's.
[[nodiscard]] Result<FileRead<SphericalTable>> parseRt300sTable(std::string_view text,
                                                                std::string_view name);

}  // namespace gonio::proc
