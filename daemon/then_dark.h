#pragma once
// However a measurement ended: dark, and nothing on its way.

#include "daemon/measurement.h"

namespace gonio::daemon {

/// `measured`, which was evaluated before. A rig that does not hear it goes dark by itself, and
/// nobody waits for it; what was measured is measured.
template <class Measured>
Result<Measured> thenDark(const Bench& bench, Result<Measured> measured) {
    if (measured) bench.attendance.captured();
    (void)bench.rig.darken();
    return measured;
}

}  // namespace gonio::daemon
