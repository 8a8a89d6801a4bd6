#include "proc/table/spherical_table.h"

#include <algorithm>

namespace gonio::proc {

LightView SphericalTable::pairAt(const SphericalBlock& block,
                                 std::size_t azimuth,
                                 std::size_t theta) const {
    const double phi = block.lightAzimuthDeg + 180 + block.azimuthDeg[azimuth] - mirrorAzimuthDeg;
    return {.in = Direction::fromSpherical(Radians::fromDegrees(block.incidenceDeg),
                                           Radians::fromDegrees(block.lightAzimuthDeg)),
            .out = Direction::fromSpherical(Radians::fromDegrees(block.thetaDeg[theta]),
                                            Radians::fromDegrees(phi))};
}

bool SphericalTable::isotropic() const {
    return std::all_of(blocks.begin(), blocks.end(), [&](const SphericalBlock& block) {
        return block.lightAzimuthDeg == blocks.front().lightAzimuthDeg;
    });
}

}  // namespace gonio::proc
