#pragma once
// BRDF and BTDF in blocks of normal-relative spherical coordinates, as LightTools, Speos, UTIA,
// SSDD and .mbsdf files hold them: each block is one light direction and one channel, with axes of
// its own.
//
// Axes are the file's numbers in degrees, ascending. theta_o is counted from the sample's normal,
// so that transmission runs from 90 to 180. The azimuth axis counts from a file's own zero: the
// mirror direction of the light lies at `mirrorAzimuthDeg`, counter-clockwise seen from above, and
// turns with the light. wo = fromSpherical(theta, lightAzimuth + 180 deg + azimuth -
// mirrorAzimuth).

#include <cstddef>
#include <limits>
#include <vector>

#include "proc/core/direction.h"
#include "proc/table/channel.h"

namespace gonio::proc {

/// Directions nearer than this are one, in degrees: readers refuse axes with smaller steps.
inline constexpr double kFinestStepDeg = 1e-6;

struct SphericalBlock {
    std::size_t channel = 0;
    double lightAzimuthDeg = 0;  ///< in the sample's frame, [0, 360)
    double incidenceDeg = 0;     ///< [0, 90)
    bool transmission = false;
    std::vector<double> azimuthDeg, thetaDeg;
    std::vector<double> f;  ///< 1/sr, azimuth > theta (fastest); NaN: no data
    /// Fraction of the incident power as the file says, never believed; NaN: not said.
    double tis = std::numeric_limits<double>::quiet_NaN();

    /// One azimuth stands for all: the light comes along the normal.
    [[nodiscard]] bool isRound() const { return incidenceDeg == 0 && azimuthDeg.size() == 1; }
    [[nodiscard]] std::size_t index(std::size_t azimuth, std::size_t theta) const {
        return azimuth * thetaDeg.size() + theta;
    }
};

struct SphericalTable {
    std::vector<Channel> channels;
    double mirrorAzimuthDeg = 180;
    /// The azimuths cover one side of the plane of incidence, and the other mirrors it.
    bool planeSymmetrical = false;
    /// Values are those of even cells, at whose centres they stand: an axis ends half a step before
    /// its range does, and out there its last value holds.
    bool cellCentred = false;
    std::vector<SphericalBlock> blocks;

    [[nodiscard]] LightView pairAt(const SphericalBlock& block,
                                   std::size_t azimuth,
                                   std::size_t theta) const;
    /// Light directions have one azimuth only.
    [[nodiscard]] bool isotropic() const;
};

}  // namespace gonio::proc
