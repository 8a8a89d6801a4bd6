#pragma once
// The simulated rig of the coverage study: its sensor and its lens, a strip of the sensor that lies
// in the plane of incidence, and what the host does with the strip's frames. The strip is as many
// windows of 32 x 32 pixels, side by side; a repeat looks at 64 of them or fewer. What changes from
// repeat to repeat is in Draw: nothing else is random.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proc/calibrate/two_point.h"
#include "proc/core/scatterer.h"
#include "proc/optics/binning.h"
#include "proc/optics/lens_fit.h"
#include "proc/radiance/dark.h"
#include "sim/placement.h"
#include "sim/sensor.h"
#include "sim/stage.h"

namespace gonio::study {

inline constexpr double kLedDrift = 0.002;            // relative, k = 1
inline constexpr Radians kWedgeTolerance = 0.01_deg;  // k = 1
inline constexpr Radians kSampleTilt = 0.2_deg;       // about either axis, k = 1
inline constexpr Band kBand = Band::G;

/// What a repeat draws: all of it from its seed.
class Draw {
public:
    explicit Draw(std::uint64_t seed) : seed_(seed) {}
    /// A standard normal deviate of its own for each name and number.
    [[nodiscard]] double normal(std::string_view what, std::uint64_t number) const;
    [[nodiscard]] sim::Flaws flaws() const;
    [[nodiscard]] sim::Wedge tilt(std::uint64_t material) const;
    [[nodiscard]] std::uint64_t seed() const { return seed_; }

private:
    std::uint64_t seed_;
};

class StudyRig {
public:
    explicit StudyRig(const sim::View& strip);

    /// As `gonio calibrate mirror` makes it: nine wedges that are off, spots to 0.03 pixel.
    [[nodiscard]] proc::LensFit lensMap(const Draw& draw) const;
    [[nodiscard]] Window window() const;
    /// Four frames of each exposure.
    [[nodiscard]] proc::DarkLibrary darks(const Draw& draw) const;
    /// One capture: the LED gives 1 + kLedDrift z of its light, and the bracket goes as low as a
    /// glossy sample needs or only as low as a matt one. `number`: of the capture in its repeat.
    [[nodiscard]] proc::CellSignal signal(const sim::Placement& placement,
                                          int led,
                                          bool glossy,
                                          std::uint64_t number,
                                          const Draw& draw,
                                          const proc::DarkLibrary& darks,
                                          const proc::Binning& binning) const;

private:
    [[nodiscard]] Frame frame(const Image<float>* rate,
                              double output,
                              double level,
                              std::uint32_t exposureUs,
                              const sim::NoiseKey& key) const;

    sim::View strip_;
    sim::Optics optics_;
    sim::Sensor sensor_;
    sim::FieldOfView field_;
};

}  // namespace gonio::study
