#pragma once
// However a measurement ended: dark, and nothing on its way.

#include "driver/rig.h"

namespace gonio::daemon {

/// `measured`, which was evaluated before. A rig that does not hear it goes dark by itself; what
/// was measured is measured.
template <class Measured>
Measured thenDark(driver::Rig& rig, Measured measured) {
    (void)rig.darken();
    return measured;
}

}  // namespace gonio::daemon
