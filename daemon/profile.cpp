#include "daemon/profile.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <optional>
#include <span>
#include <sstream>

#include "driver/protocol/crc.h"
#include "proc/formats/file_bytes.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestUs = 3.6e9;  // an hour
constexpr Seconds kHour = std::chrono::hours(1), kDay = std::chrono::hours(24);
constexpr std::string_view kIdealWhite = "1/pi";
constexpr std::string_view kSchema = "gonio/rig/1";

/// Reads keys of one file; remembers the first that is missing or out of its domain.
class Keys {
public:
    Keys(const toml::table& table, std::string file) : table_(table), file_(std::move(file)) {}

    double positive(std::string_view key) {
        const auto value = table_.at_path(key).value<double>();
        if (!value || !(*value > 0)) complain(key, "a number above 0");
        return value.value_or(1);
    }
    double positiveOr(std::string_view key, double otherwise) {
        return table_.at_path(key) ? positive(key) : otherwise;
    }
    /// From 0 to below 1.
    double relative(std::string_view key) {
        const auto value = table_.at_path(key).value<double>();
        if (!value || !(*value >= 0 && *value < 1)) complain(key, "a number from 0 to below 1");
        return value.value_or(0);
    }
    double relativeOr(std::string_view key, double otherwise) {
        return table_.at_path(key) ? relative(key) : otherwise;
    }
    std::string text(std::string_view key) {
        const auto value = table_.at_path(key).value<std::string>();
        if (!value || value->empty()) complain(key, "a text");
        return value.value_or("");
    }
    /// One of the two.
    int either(std::string_view key, int first, int second) {
        const auto value = table_.at_path(key).value<std::int64_t>();
        if (value == first || value == second) return static_cast<int>(*value);
        complain(key, std::to_string(first) + " or " + std::to_string(second));
        return first;
    }
    /// What kind of file it is, and of which version.
    void schema(std::string_view wanted) {
        const auto value = table_["schema"].value<std::string>();
        if (value == wanted) return;
        complain("schema",
                 "\"" + std::string(wanted) + "\", " +
                     (value ? "saw \"" + *value + "\"" : "it is missing") +
                     ": not a rig profile that this program knows");
    }
    /// Ascending.
    std::vector<Microseconds> wholeMicroseconds(std::string_view key) {
        std::vector<double> values = numbers(key);
        std::sort(values.begin(), values.end());
        std::vector<Microseconds> exposures;
        exposures.reserve(values.size());
        for (double us : values) exposures.emplace_back(static_cast<std::int64_t>(us));
        const bool whole = std::all_of(values.begin(), values.end(), [](double us) {
            return us >= 1 && us <= kLongestUs && us == std::floor(us);
        });
        if (!whole || !differ(values)) complain(key, "a list of different whole numbers above 0");
        return exposures;
    }
    /// Descending.
    std::vector<double> fractions(std::string_view key) {
        std::vector<double> values = numbers(key);
        std::sort(values.rbegin(), values.rend());
        const bool inside = std::all_of(
            values.begin(), values.end(), [](double level) { return level > 0 && level < 1; });
        if (!inside || !differ(values)) {
            complain(key, "a list of different numbers between 0 and 1");
        }
        return values;
    }
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    std::vector<double> numbers(std::string_view key) {
        std::vector<double> values;
        const toml::array* array = table_.at_path(key).as_array();
        if (array != nullptr) {
            for (const toml::node& node : *array) {
                if (const auto value = node.value<double>()) values.push_back(*value);
            }
        }
        if (array == nullptr || values.empty() || values.size() != array->size()) {
            complain(key, "a list of numbers");
        }
        return values;
    }
    static bool differ(const std::vector<double>& sorted) {
        return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
    }
    void complain(std::string_view key, std::string_view wanted) {
        if (error_) return;
        error_ = Error{ErrorKind::File,
                       file_ + ": key '" + std::string(key) + "': wanted " + std::string(wanted)};
    }
    const toml::table& table_;
    std::string file_;
    std::optional<Error> error_;
};

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
    const Result<std::string> text = proc::readFile(file);
    if (!text) return text.error();
    toml::table table;
    try {
        table = toml::parse(*text);
    } catch (const toml::parse_error& error) {
        return Error{ErrorKind::File, file.string() + ": " + std::string(error.description())};
    }
    Keys keys(table, file.string());
    RigProfile profile;
    keys.schema(kSchema);
    profile.hash = hashOf(*text);
    profile.name = keys.text("name");
    profile.cameraUsb = keys.either("camera.usb", 2, 3);
    profile.noise.electronsPerDn = keys.positive("sensor.electrons_per_dn");
    profile.noise.readNoiseElectrons = keys.positive("sensor.read_noise_electrons");
    profile.noise.darkElectronsPerSecond = keys.positive("sensor.dark_electrons_per_second");
    profile.noise.fullScaleDn = keys.positive("sensor.full_scale_dn");
    profile.wedgeTolerance = Radians::fromDegrees(keys.positive("mirror.wedge_u_deg"));
    profile.ledDrift = keys.relative("led.drift_relative");
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
    if (keys.error()) return *keys.error();
    return profile;
}

}  // namespace gonio::daemon
