#include "proc/optics/mirror.h"

#include <array>

namespace gonio::proc {

std::span<const Wedge> mirrorWedges() {
    static constexpr std::array<Wedge, 9> kWedges{{
        {0_deg, 0_deg},
        {15_deg, 0_deg},
        {-15_deg, 0_deg},
        {0_deg, 15_deg},
        {0_deg, -15_deg},
        {25_deg, 0_deg},
        {-25_deg, 0_deg},
        {0_deg, 25_deg},
        {0_deg, -25_deg},
    }};
    return kWedges;
}

Direction mirroredBy(const Wedge& wedge, const Direction& light) {
    // Ry Rx z, written out.
    const Eigen::Vector3d normal(sin(wedge.aboutY) * cos(wedge.aboutX),
                                 -sin(wedge.aboutX),
                                 cos(wedge.aboutY) * cos(wedge.aboutX));
    const Eigen::Vector3d& wi = light.vector();
    return *Direction::fromVector(2 * normal.dot(wi) * normal - wi);
}

}  // namespace gonio::proc
