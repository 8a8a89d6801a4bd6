#pragma once
// The native measured sample: for each LED and band, BRDF with uncertainties and flags over the
// cells of CellGrid, and everything known about how it came about. It is what a `.gonio` file holds
// and what `measure` makes.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proc/calibrate/cell_samples.h"
#include "proc/core/bands.h"
#include "proc/core/direction.h"
#include "proc/core/units.h"

namespace gonio::proc {

struct SampleInfo {
    std::string name;
    std::string rigSerial;
    std::string profileHash;  ///< of the rig's profile
    std::string calibrationId;
    std::string session;
    std::string dateUtc;  ///< ISO 8601
    std::string operatorNotes;
    std::string softwareVersion;
    std::string effort;
    std::string referenceCertificate;
    std::string qcVerdicts;
    std::string truthSpec;   ///< what lay under a simulated rig; empty for a real one
    std::string budgetJson;  ///< the uncertainty budget, as JSON text
    double rigSeconds = 0;
    double computeSeconds = 0;
    std::optional<double> requestedUncertainty;  ///< relative, k = 1
    std::optional<double> achievedUncertainty;
    int interruptions = 0;
    std::map<std::string, std::string> extra;

    bool operator==(const SampleInfo&) const = default;
};

/// What one LED measured. The cells are in the rig's frame, in which the light stands at phi = 0.
struct LedTable {
    Radians incidence;
    Radians rotation{};  ///< of the sample about its normal, in [0, 2 pi): rotations.h
    std::array<CellSamples, 3> bands;  ///< R, G, B; an empty one was not measured
};

/// The light in the sample's own frame: rotation r turns the sample by +r under a fixed light, so
/// that there the light stands at phi = -r.
[[nodiscard]] inline Direction lightOf(const LedTable& led) {
    return Direction::fromSpherical(led.incidence, -led.rotation);
}
/// The pair of a direction of the rig's frame, in the sample's own; wo is as it is at rotation 0.
[[nodiscard]] inline LightView pairInSample(const LedTable& led, const Direction& wo) {
    const bool turned = led.rotation != Radians();
    return {.in = lightOf(led), .out = turned ? wo.turned(-led.rotation) : wo};
}

/// Of each rotation at most 8 LEDs, and 36 rotations of a rig's four; each takes some 2 MB.
inline constexpr std::size_t kMostTables = 144;

/// LEDs by ascending rotation, and of each rotation by ascending incidence.
struct SampleSet {
    SampleInfo info;
    std::vector<LedTable> leds;
};

}  // namespace gonio::proc
