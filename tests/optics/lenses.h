#pragma once
// Lens maps for tests: unlike f-theta in every way that a real one is.

#include "proc/core/frame.h"
#include "proc/optics/lens_map.h"

namespace gonio::test {

/// Off centre, turned, elliptic, and bent, as a bad day in the workshop would make it.
inline proc::LensMap crookedLens() {
    return proc::LensMap({.centreX = 645.3,
                          .centreY = 506.8,
                          .rotation = 0.012,
                          .a = 0.002,
                          .b = -0.0015,
                          .c1 = 1.33,
                          .c3 = 0.021,
                          .c5 = -0.004});
}

/// The square window in the middle of a 1280 x 1024 sensor.
inline Window middleWindow(int binning = 1) {
    return {.x = 128, .y = 0, .size = {1024, 1024}, .binning = binning};
}

}  // namespace gonio::test
