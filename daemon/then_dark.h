#pragma once
// However a measurement ended: dark, and nothing on its way.

#include "daemon/measurement.h"
#include "proc/core/log.h"

namespace gonio::daemon {

/// `measured`, which was evaluated before. A rig that is lost goes dark by itself, and nobody waits
/// for it; what was measured is measured. One that will not go dark is told of: its owner has to
/// see to it.
template <class Measured>
Result<Measured> thenDark(const Bench& bench, Result<Measured> measured) {
    if (measured) bench.attendance.captured();
    if (bench.rig.link().lost()) return measured;
    const Result<void> dark = bench.rig.darken();
    if (!dark && !bench.rig.link().lost()) log::warning(dark.error().message);
    return measured;
}

}  // namespace gonio::daemon
