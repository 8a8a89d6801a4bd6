#pragma once
// Where a reported sample and its report come from: what the sample itself does not carry.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gonio::proc {

/// A calibration that the sample was worked out with.
struct ReportedCalibration {
    std::string kind;  ///< "mirror", "white", ...
    std::int64_t number = 0;
    std::string dateUtc;
    std::optional<double> ageHours;  ///< when the sample was measured
    std::optional<double> celsius;   ///< of the LED board
    std::string profileHash;         ///< of the rig profile; empty: not known
};

struct ReportOrigin {
    std::string file;    ///< as it was asked for
    std::string digest;  ///< SHA-256 of the file, hexadecimal
    std::string madeUtc;
    std::string madeBy;        ///< program and version
    std::string operatorName;  ///< of the session; empty: not known
    std::vector<ReportedCalibration> calibrations;
    std::string noCalibrations;  ///< why there are none
};

}  // namespace gonio::proc
