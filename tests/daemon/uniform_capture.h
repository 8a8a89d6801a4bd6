#pragma once
// Raw captures and lens maps made up for tests: uniform radiance, an even f-theta lens.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "daemon/rig_calibration.h"
#include "proc/formats/graw_exr.h"

namespace gonio::test {

/// All bands of these LEDs, at one radiance.
inline std::string uniformCapture(const std::vector<int>& leds,
                                  float radiance = 100,
                                  Size size = {700, 700}) {
    proc::RawCapture capture;
    for (const int led : leds) {
        for (const Band band : kBands) {
            proc::RawState state;
            state.merged = {.radiance = Image<float>(size, radiance),
                            .variance = Image<float>(size, 1.F),
                            .used = Image<std::uint8_t>(size, 1),
                            .saturated = Image<std::uint8_t>(size, 0),
                            .window = {.x = 0, .y = 0, .size = size},
                            .led = led,
                            .band = band};
            capture.states.push_back(std::move(state));
        }
    }
    const auto bytes = proc::encodeGraw(std::move(capture));
    EXPECT_TRUE(bytes) << bytes.error().message;
    return bytes ? *bytes : std::string();
}

inline daemon::LensRecord evenLens(double pixelsPerDegree, double middle = 350) {
    return {.fit = {.map = proc::LensMap::fTheta({middle, middle}, pixelsPerDegree),
                    .covariance = 1e-10 * Eigen::MatrixXd::Identity(8, 8)},
            .spots = 20,
            .dateUtc = "t"};
}

}  // namespace gonio::test
