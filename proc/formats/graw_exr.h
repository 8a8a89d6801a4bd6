#pragma once
// Raw captures `.graw`: an OpenEXR multi-part file, one part per state (LED x band) with the merged
// radiance, so that calibrations can be applied again at any time. Channels radiance, variance
// (FLOAT; NaN where every frame was saturated), used, saturated (UINT, samples per pixel); the
// bracket's exposures, levels, temperatures and black levels stand as JSON in an attribute.

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/radiance/merge.h"

namespace gonio::proc {

inline constexpr std::string_view kRawSchema = "gonio/raw/1";

/// The frames of one capture that entered a state: same exposure, same level.
struct RawExposure {
    std::uint64_t captureId = 0;
    Nanoseconds granted{0};
    std::uint16_t level = 0;
    int frames = 0;
    std::uint16_t blackLevel = 0;                  ///< DN
    std::array<std::optional<double>, 4> celsius;  ///< LED board, sensor, body, ambient
    /// Effective time over nominal, as the bracket's own pictures tell it (group_scales.h), and its
    /// standard uncertainty.
    double scale = 1, uScale = 0;
    double milliamp = 0;  ///< measured current of the lit band, mean over the frames; 0: not known

    bool operator==(const RawExposure&) const = default;
};

struct RawState {
    MergedState merged;
    std::vector<RawExposure> bracket;
};

struct RawCapture {
    std::map<std::string, std::string> info;  ///< sample, rig serial, session, date, ...
    std::vector<RawState> states;
};

/// Internal error for a capture without states, or with the same state twice.
[[nodiscard]] Result<std::string> encodeGraw(RawCapture capture);
[[nodiscard]] Result<RawCapture> decodeGraw(std::string_view bytes, std::string_view name);

[[nodiscard]] Result<void> writeGraw(const std::filesystem::path& path, const RawCapture& capture);
/// Up to 2 GiB: 36 states of a megapixel are 600 MB before compression.
[[nodiscard]] Result<RawCapture> readGraw(const std::filesystem::path& path);

}  // namespace gonio::proc
