#pragma once
// The pictures that a rig's measurements are made of: of single sensor pixels, or binned as little
// as a rig can that sends no others.

#include <bit>

#include "driver/protocol/reports.h"

namespace gonio::daemon {

/// 1, 2 or 4; 1 where the rig names none.
[[nodiscard]] constexpr int finestBinning(const driver::Limits& limits) {
    const unsigned named = limits.binnings & 0b111U;
    return named == 0 ? 1 : 1 << std::countr_zero(named);
}

}  // namespace gonio::daemon
