#include "proc/core/quantities.h"

#include <limits>

namespace gonio {

Brdf toBrdf(Ars ars, double cosThetaOut) {
    if (!(cosThetaOut >= kMinCosForBrdf)) return Brdf(std::numeric_limits<double>::quiet_NaN());
    return Brdf(ars.value() / cosThetaOut);
}

}  // namespace gonio
