#pragma once
// Angles as files hold them: degrees, rounded to 1e-9, so that 20 degrees that went through radians
// are written as 20 and read back to the same bits.

#include <cmath>

#include "proc/core/units.h"

namespace gonio::proc {

[[nodiscard]] inline double roundedDegrees(double degrees) {
    return std::round(degrees * 1e9) / 1e9;
}

[[nodiscard]] inline double fileDegrees(Radians angle) { return roundedDegrees(angle.degrees()); }

}  // namespace gonio::proc
