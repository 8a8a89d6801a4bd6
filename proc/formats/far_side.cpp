#include "proc/formats/far_side.h"

#include <algorithm>

#include "proc/formats/file_degrees.h"

namespace gonio::proc {

void turnOver(SphericalBlock& block) {
    std::reverse(block.thetaDeg.begin(), block.thetaDeg.end());
    for (double& theta : block.thetaDeg) theta = 180 - theta;
    const auto size = static_cast<std::ptrdiff_t>(block.thetaDeg.size());
    for (auto row = block.f.begin(); row != block.f.end(); row += size) {
        std::reverse(row, row + size);
    }
}

std::vector<double> thetasFromOwnNormal(const SphericalBlock& block) {
    std::vector<double> thetas;
    for (const double theta : block.thetaDeg) {
        thetas.push_back(roundedDegrees(block.transmission ? 180 - theta : theta));
    }
    if (block.transmission) std::reverse(thetas.begin(), thetas.end());
    return thetas;
}

}  // namespace gonio::proc
