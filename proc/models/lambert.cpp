#include "proc/models/lambert.h"

namespace gonio::proc {

LedBands Lambert::evaluate(const LightView&) const { return albedo_ * (1 / kPi); }

}  // namespace gonio::proc
