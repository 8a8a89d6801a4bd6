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

/// What one LED measured. The light stands at phi = 0.
struct LedTable {
    Radians incidence;
    std::array<CellSamples, 3> bands;  ///< R, G, B; an empty one was not measured
};

/// LEDs by ascending incidence.
struct SampleSet {
    SampleInfo info;
    std::vector<LedTable> leds;
};

}  // namespace gonio::proc
