#include "driver/identity.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace gonio::driver {
namespace {

Error deviceError(const std::string& what) { return {ErrorKind::Device, what}; }

struct Version {
    unsigned major = 0, minor = 0;
    [[nodiscard]] std::string text() const {
        return "GRP/" + std::to_string(major) + "." + std::to_string(minor);
    }
};

/// "GRP/1.0", whole.
std::optional<Version> parseVersion(const std::string& text) {
    constexpr std::string_view kPrefix = "GRP/";
    if (!text.starts_with(kPrefix)) return std::nullopt;
    const char* end = text.data() + text.size();
    Version version;
    const auto major = std::from_chars(text.data() + kPrefix.size(), end, version.major);
    if (major.ec != std::errc{} || major.ptr == end || *major.ptr != '.') return std::nullopt;
    const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
    if (minor.ec != std::errc{} || minor.ptr != end) return std::nullopt;
    return version;
}

Result<void> checkVersion(const std::string& rig, const Version& theirs) {
    constexpr Version ours{.major = kProtocolMajor, .minor = kProtocolMinor};
    if (theirs.major == ours.major) return {};
    return deviceError(rig + " speaks " + theirs.text() + ", this program " + ours.text() +
                       ": it can be identified, not run; update the older of the two");
}

constexpr std::size_t kMostSerial = 32;

bool isPrintable(char c) { return c > ' ' && c <= '~'; }

bool soundSerial(const std::string& serial) {
    return !serial.empty() && serial.size() <= kMostSerial &&
           std::all_of(serial.begin(), serial.end(), isPrintable);
}

/// What a device says of itself goes to terminals and logs.
std::string printable(const std::string& text, std::size_t most) {
    std::string safe = text.substr(0, most);
    std::replace_if(
        safe.begin(), safe.end(), [](char c) { return !isPrintable(c); }, '?');
    return safe;
}

/// The first field of IDENT or LIMITS that no rig can mean; sizes and waits are computed from them.
std::optional<std::string> implausible(const Ident& ident, const Limits& limits) {
    constexpr std::uint32_t kMaxPayload = 16U << 20;    // usbfs allows no larger transfers
    constexpr std::uint32_t kMaxPeriodUs = 60'000'000;  // keeps every deadline finite
    const auto field = [](const char* name, std::uint64_t value) {
        return std::string(name) + " " + std::to_string(value);
    };
    if (ident.ledCount < 1 || ident.ledCount > kMaxLeds) return field("led_count", ident.ledCount);
    if (ident.sensorWidth == 0) return field("sensor_width", ident.sensorWidth);
    if (ident.sensorHeight == 0) return field("sensor_height", ident.sensorHeight);
    // frame_bytes has 32 bits on the wire.
    if (std::uint64_t{2} * ident.sensorWidth * ident.sensorHeight > 0xFFFFFFFFU)
        return field("sensor_height", ident.sensorHeight);
    if (ident.bitDepth < 1 || ident.bitDepth > 16) return field("bit_depth", ident.bitDepth);
    if (ident.maxChunkPayload == 0 || ident.maxChunkPayload > kMaxPayload)
        return field("max_chunk_payload", ident.maxChunkPayload);
    if (ident.exposureMinUs > ident.exposureMaxUs)
        return field("exposure_min_us", ident.exposureMinUs);
    if (ident.controlLatency == 0) return field("control_latency", ident.controlLatency);
    if (limits.maxFrames == 0) return field("max_frames", limits.maxFrames);
    if (limits.roiStep == 0) return field("roi_step", limits.roiStep);
    if (limits.framePeriodUs == 0 || limits.framePeriodUs > kMaxPeriodUs)
        return field("frame_period_us", limits.framePeriodUs);
    if (limits.fullScale <= limits.blackLevel) return field("full_scale", limits.fullScale);
    if (limits.fullScale >> ident.bitDepth != 0) return field("full_scale", limits.fullScale);
    if ((limits.formats & 3U) == 0) return field("formats", limits.formats);
    return std::nullopt;
}

}  // namespace

std::string rigName(const DeviceStrings& strings) {
    return "rig " + printable(strings.serial, kMostSerial);
}

Result<void> checkSerial(const DeviceStrings& strings) {
    if (soundSerial(strings.serial)) return {};
    return deviceError("serial number \"" + printable(strings.serial, kMostSerial) +
                       "\" is not 1..32 printable characters");
}

Result<Identity> readIdentity(Transport& transport) {
    const DeviceStrings strings = transport.strings();
    if (auto sound = checkSerial(strings); !sound) return sound.error();
    const auto version = parseVersion(strings.protocol);
    if (!version) {
        return deviceError("string 240 is \"" + printable(strings.protocol, kMostSerial) +
                           "\", wanted \"GRP/" + std::to_string(kProtocolMajor) +
                           ".x\": not a gonio rig");
    }
    if (auto same = checkVersion(rigName(strings), *version); !same) return same.error();
    const auto ident = readFeature(transport, ReportId::Ident, decodeIdent);
    if (!ident) return ident.error();
    const Version theirs{.major = ident->major, .minor = ident->minor};
    if (auto same = checkVersion(rigName(strings), theirs); !same) return same.error();
    const auto limits = readFeature(transport, ReportId::Limits, decodeLimits);
    if (!limits) return limits.error();
    if (const auto field = implausible(*ident, *limits)) {
        return deviceError("IDENT or LIMITS cannot be: " + *field);
    }
    return Identity{.strings = strings, .ident = *ident, .limits = *limits};
}

}  // namespace gonio::driver
