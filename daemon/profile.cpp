#include "daemon/profile.h"

#include <cstdlib>
#include <iomanip>
#include <span>
#include <sstream>

#include "daemon/toml_keys.h"
#include "driver/protocol/crc.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

constexpr Seconds kHour = std::chrono::hours(1), kDay = std::chrono::hours(24);
constexpr std::string_view kIdealWhite = "1/pi";
constexpr std::string_view kSchema = "gonio/rig/1";

/// The file but for what has no bearing on a calibration: [quality] and the empty line before it.
std::string physical(const std::string& text) {
    std::istringstream lines(text);
    std::string kept, line;
    bool left = true;
    while (std::getline(lines, line)) {
        if (line.starts_with("[")) {
            left = !line.starts_with("[quality]");
            if (!left && kept.ends_with("\n\n")) kept.pop_back();
        }
        if (left) kept += line + "\n";
    }
    return kept;
}

std::string hashOf(std::string_view text) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    std::ostringstream hex;
    hex << std::hex << std::setw(8) << std::setfill('0')
        << driver::crc32c(std::span(bytes, text.size()));
    return hex.str();
}

}  // namespace

fs::path configDirectory() {
    if (const char* set = std::getenv("GONIO_CONFIG"); set != nullptr && *set != '\0') return set;
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    fs::path installed = program.parent_path().parent_path() / "share" / "gonio";
    if (fs::is_directory(installed / "rigs", ignored)) return installed;
    return GONIO_CONFIG_DIR;
}

fs::path defaultProfile() { return configDirectory() / "rigs" / "minidiff-usb2.toml"; }

Result<RigProfile> readProfile(const fs::path& file) {
    Result<TomlKeys> read = TomlKeys::read(file, kSchema);
    if (!read) return read.error();
    TomlKeys& keys = *read;
    RigProfile profile;
    profile.hash = hashOf(physical(keys.bytes()));
    profile.name = keys.text("name");
    profile.cameraUsb = keys.either("camera.usb", 2, 3);
    profile.noise.electronsPerDn = keys.positive("sensor.electrons_per_dn");
    profile.noise.readNoiseElectrons = keys.positive("sensor.read_noise_electrons");
    profile.noise.darkElectronsPerSecond = keys.positive("sensor.dark_electrons_per_second");
    profile.noise.fullScaleDn = keys.positive("sensor.full_scale_dn");
    profile.wedgeTolerance = Radians::fromDegrees(keys.positive("mirror.wedge_u_deg"));
    profile.ledDrift = keys.relative("led.drift_relative");
    profile.warmUp = Seconds(keys.notNegativeOr("led.warm_up_s", profile.warmUp.count()));
    profile.exposureRatio = keys.relativeOr("uncertainty.exposure_ratio_relative", 0);
    profile.linearity = keys.relativeOr("uncertainty.linearity_relative", 0);
    profile.exposures = keys.wholeMicroseconds("bracket.exposures_us");
    profile.dimLevels = keys.fractions("bracket.dim_levels");
    const std::string white = keys.text("references.white");
    if (white != kIdealWhite) profile.whiteReference = configDirectory() / white;
    profile.blackReflectance = keys.positive("references.black_reflectance");
    profile.blackRelativeUncertainty = keys.positive("references.black_relative_uncertainty");
    profile.zeroUncertainty =
        keys.positiveOr("references.zero_uncertainty_per_sr", profile.zeroUncertainty);
    ValidityLimits& good = profile.validity;
    good.mirror = kDay * keys.positiveOr("validity.mirror_days", good.mirror / kDay);
    good.tiles = kHour * keys.positiveOr("validity.tile_hours", good.tiles / kHour);
    good.kelvin = keys.positiveOr("validity.kelvin", good.kelvin);
    const std::string limits = keys.textOr("quality.limits", "");
    keys.nothingElse();
    if (keys.error()) return *keys.error();
    if (!limits.empty()) {
        Result<JudgingLimits> judging = readLimits(configDirectory() / limits);
        if (!judging) return judging.error().in(file.string() + ": key 'quality.limits'");
        profile.quality = *judging;
    }
    return profile;
}

}  // namespace gonio::daemon
