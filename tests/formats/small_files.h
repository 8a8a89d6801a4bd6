#pragma once
// One small valid file of each format, for tests that then damage it.

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "proc/formats/exr_parts.h"
#include "proc/formats/graw_exr.h"
#include "tests/support/sample_sets.h"

namespace gonio::test {

/// `text` with the first `from` in it replaced; `from` must be there.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
}

/// Two incidences, three azimuths, three radials; the data are on lines 17..24.
inline std::string smallZemax() {
    return "# a comment\n"
           "Source  Measured\n"
           "Symmetry  PlaneSymmetrical\n"
           "SpectralContent  Monochrome\n"
           "ScatterType  BRDF\n"
           "SampleRotation  1\n"
           "0\n"
           "AngleOfIncidence  2\n"
           "10\t30\n"
           "ScatterAzimuth  3\n"
           "0\t90\t180\n"
           "ScatterRadial  3\n"
           "0\t20\t40\n"
           "\n"
           "Monochrome\n"
           "DataBegin\n"
           "TIS  0.25\n"
           "0.5\t0.4\t0.1\n"
           "0.5\t0.3\t0.2\n"
           "0.5\t0.2\t0.3\n"
           "TIS  0.3\n"
           "0.6\t0.5\t0.2\n"
           "0.6\t0.4\t0.3\n"
           "0.6\t0.3\t0\n"
           "DataEnd\n";
}

inline std::string smallPoints() {
    return "# pairs\n"
           "theta_i,phi_i,theta_o,phi_o,\"name, or none\"\n"
           "0,0,45,90,normal\n"
           "30,0,30,180,\"mirror, exact\"\n"
           "\n"
           "60,10,90,190,horizon\n";
}

/// One LED, one band, the same f in every cell: packs into a few kilobytes.
inline proc::SampleSet smallSample() {
    proc::SampleSet set;
    set.info.name = "test tile";
    set.info.extra["key"] = "value";
    set.leds = {ledTable(20_deg, [](Radians, const Direction&) { return 0.25; })};
    set.leds[0].bands[index(Band::R)] = {};
    set.leds[0].bands[index(Band::B)] = {};
    return set;
}

/// A state of 4 x 3 pixels, of which the first is saturated in every frame.
inline proc::RawState smallState(int led, Band band) {
    constexpr Size kSize{4, 3};
    proc::RawState state;
    proc::MergedState& m = state.merged;
    m.radiance = Image<float>(kSize);
    for (std::size_t i = 0; i < kSize.pixels(); ++i) {
        m.radiance.pixels()[i] = 0.1F * static_cast<float>(i) - 0.3F;
    }
    m.variance = Image<float>(kSize, 2.5F);
    m.used = Image<std::uint8_t>(kSize, 7);
    m.saturated = Image<std::uint8_t>(kSize, 0);
    m.radiance.at(0, 0) = m.variance.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
    m.used.at(0, 0) = 0;
    m.saturated.at(0, 0) = 255;
    m.window = {.x = 16, .y = 8, .size = {8, 6}, .binning = 2};
    m.led = led;
    m.band = band;
    m.allSaturatedPixels = 1;
    m.chiSquare = 10.25;
    m.freedom = 11;
    state.bracket = {{.captureId = 0xFFFF'FFFF'FFFF'FFFF,
                      .granted = Nanoseconds(1'000'123),
                      .level = 65535,
                      .frames = 4,
                      .blackLevel = 60,
                      .celsius = {25.5, std::nullopt, -3.0, std::nullopt}},
                     {.captureId = 2, .granted = Nanoseconds(64'000'000), .level = 1, .frames = 3}};
    return state;
}

inline proc::RawCapture smallCapture() {
    return {.info = {{"sample", "test tile"}, {"session", "S1"}},
            .states = {smallState(0, Band::R), smallState(0, Band::B), smallState(2, Band::G)}};
}

}  // namespace gonio::test
