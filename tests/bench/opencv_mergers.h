#pragma once
// OpenCV's mergers as outside peers. Those of Debian 12 (4.6) take 8-bit pictures only: a DN of 12
// bit is taken from black level .. 4095 to 0 .. 255 and rounded, so that full scale is the 255
// whose weight is smallest, a linear response is given, and one factor common to all levels is
// fitted to the truth afterwards, as the result has no unit.

#include <string>
#include <vector>

#include "proc/core/frame.h"

namespace gonio::bench {

struct OpenCvResult {
    std::string name;
    std::vector<float> light;  ///< per pixel, in a unit of its own
};

[[nodiscard]] std::vector<OpenCvResult> openCvMerged(const std::vector<Frame>& bracket);

}  // namespace gonio::bench
