// A foreign project that knows only the installed package: a GGX lobe must answer the same light
// when light and camera change places.

#include <cmath>
#include <iostream>

#include "proc/core/direction.h"
#include "proc/core/units.h"
#include "proc/models/spec.h"

int main() {
    using namespace gonio;
    const auto model = proc::makeModel("lambert,albedo=0.2+ggx,alpha=0.3,f0=0.04");
    if (!model) {
        std::cerr << model.error().message << '\n';
        return exitCode(model.error().kind);
    }
    const Direction wi = Direction::fromSpherical(30_deg, 0_deg);
    const Direction wo = Direction::fromSpherical(55_deg, 140_deg);
    const double there = (*model)->answer({.in = wi, .out = wo}).f[Band::G];
    const double back = (*model)->answer({.in = wo, .out = wi}).f[Band::G];
    std::cout << "f = " << there << " 1/sr\n";
    return there > 0 && std::abs(there - back) <= 1e-12 * there ? 0 : 1;
}
