#pragma once
// Whether two surfaces agree: their difference at the cells of one incidence after another, in
// several measures, by region about the mirror direction, and against their uncertainties.
//
// In units of the combined u = hypot(u_a, u_b): `within2u` near 0.95 says that they agree as well
// as their uncertainties claim. u_systematic is common to many cells, so that a share of 0.7 or 1
// can be one error of the scale.

#include <string>
#include <vector>

#include "proc/core/scatterer.h"
#include "proc/core/units.h"

namespace gonio::proc {

/// About the mirror direction, in degrees.
struct CompareRegion {
    std::string name;
    double fromDeg = 0;
    double toDeg = 180;
};
/// all; lobe (to 10 degrees); flank (10 to 30); rest.
[[nodiscard]] const std::vector<CompareRegion>& compareRegions();

/// Sums over cells, weighted by solid angle; a is held against b.
struct Difference {
    Radians incidence;
    std::string region;
    Band band = Band::R;
    std::size_t values = 0;      ///< where both answer
    std::size_t oneOnly = 0;     ///< where one of them does
    std::size_t stated = 0;      ///< of the values: where at least one of them has a u above 0
    double relativeRms = 0;      ///< of (a - b) / b where b is not 0; NaN: nowhere
    double relativeMean = 0;     ///< of (a - b) over that of b; NaN: that is 0
    double logRms = 0;           ///< of ln(a / b), where both are positive
    double cosineRms = 0;        ///< of (a - b) cos(theta_o) over that of b cos(theta_o); or NaN
    double within2u = 0;         ///< share of `stated` within twice the combined u; NaN: none
    double meanSquareOverU = 0;  ///< of (a - b) / u over `stated`; NaN: none
};

/// One row per incidence, region and band (one band where both have one) that has values.
[[nodiscard]] std::vector<Difference> compareSurfaces(const Scatterer& a,
                                                      const Scatterer& b,
                                                      const std::vector<Radians>& incidences);

/// Everywhere and in all bands: agree, do not, or nothing is known of their uncertainties.
enum class Agreement {
    Agree,
    Disagree,
    Unknown
};
/// Agree: at least 90 % of the values within twice their u. Unknown where less than half of them
/// have one.
[[nodiscard]] Agreement agreementOf(const std::vector<Difference>& differences);
[[nodiscard]] std::string_view name(Agreement agreement);

}  // namespace gonio::proc
