#pragma once
// What a file says of a measurement beside its numbers: sample, rig, calibration, reference,
// software, ... Each format keeps what it has a place for; formats with free text keep all of it as
// lines "gonio.KEY: VALUE".

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proc/table/sample_set.h"

namespace gonio::proc {

/// Keys that formats with fields of their own look for.
namespace key {
inline constexpr std::string_view kSample = "sample";
inline constexpr std::string_view kRig = "rig";
inline constexpr std::string_view kCalibration = "calibration";
inline constexpr std::string_view kSession = "session";
inline constexpr std::string_view kDate = "date";  ///< ISO 8601, UTC
inline constexpr std::string_view kNotes = "notes";
inline constexpr std::string_view kSoftware = "software";
inline constexpr std::string_view kEffort = "effort";
inline constexpr std::string_view kReference = "reference";  ///< white reference's certificate
inline constexpr std::string_view kQuality = "qc";
inline constexpr std::string_view kWavelengths = "wavelengths_nm";          ///< "630 525 465"
inline constexpr std::string_view kSolidAngle = "detector_solid_angle_sr";  ///< of one value
/// "0": in this file, a format without a mark for it, an exact 0 is a missing value.
inline constexpr std::string_view kMissing = "missing_is";
/// "yes": the values of the file that was read hold the cosine, by which its reader has divided.
/// Of that file alone: no text says it, since what is written is f.
inline constexpr std::string_view kCosine = "cosine";
}  // namespace key

struct Metadata {
    std::map<std::string, std::string, std::less<>> values;
    std::vector<std::string> comments;  ///< free lines of the file, in order

    /// Empty where it is not said.
    [[nodiscard]] std::string_view at(std::string_view name) const;
    void set(std::string_view name, std::string value);  ///< an empty value is left out
    bool operator==(const Metadata&) const = default;
};

/// "gonio.KEY: VALUE" of each value in the order of keys, then the comments. A line end within a
/// text is written as \n, a backslash as \\. Without key::kCosine.
[[nodiscard]] std::vector<std::string> metadataLines(const Metadata& about);
/// Back again: lines that are none of ours are comments.
[[nodiscard]] Metadata metadataOfLines(std::span<const std::string> lines);

/// All that a sample says of itself. Names in `extra` that are those of its other members become
/// "extra.NAME"; infoOf() is the inverse and puts unknown keys into `extra`.
[[nodiscard]] Metadata metadataOf(const SampleInfo& info);
[[nodiscard]] SampleInfo infoOf(const Metadata& about);

}  // namespace gonio::proc
