#include "proc/models/multiple_scattering.h"

#include "proc/solve/quadrature.h"

namespace gonio::proc {

LedBands averageFresnel(const SurfaceFresnel<double>& fresnel) {
    constexpr std::size_t kNodes = 64;
    Bands<double> sum;
    for (const QuadratureNode& node : gaussLegendre(kNodes)) {
        sum = sum + fresnel.at(node.x) * (2 * node.weight * node.x);
    }
    return ledBands(sum);
}

}  // namespace gonio::proc
