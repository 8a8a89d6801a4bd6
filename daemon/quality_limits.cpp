#include "daemon/quality_limits.h"

#include <string>

#include "daemon/toml_keys.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

constexpr std::string_view kSchema = "gonio/quality/1";
constexpr Radians kSteepest = 5.000001_deg;  // that a tilt is modelled well to

/// Warned of from `section`.warned on, refused from `section`.refused on.
void readBoth(TomlKeys& keys, const std::string& section, proc::Limits& limits) {
    const std::string warned = section + ".warned", refused = section + ".refused";
    limits.warned = keys.notNegativeOr(warned, limits.warned);
    limits.refused = keys.notNegativeOr(refused, limits.refused);
    if (limits.warned <= limits.refused) return;
    keys.complain(warned,
                  "no more than " + refused + ", which is " + shortest(limits.refused) +
                      ", and it is " + shortest(limits.warned));
}

void readDegrees(TomlKeys& keys, const std::string& key, Radians& angle) {
    angle = Radians::fromDegrees(keys.positiveOr(key, angle.degrees()));
}

void readPose(TomlKeys& keys, PoseLimits& pose) {
    readDegrees(keys, "tilt.corrected_deg", pose.corrected);
    readDegrees(keys, "tilt.warned_deg", pose.warned);
    readDegrees(keys, "tilt.refused_deg", pose.refused);
    readDegrees(keys, "waviness.refused_deg", pose.wavy);
    if (pose.refused > kSteepest)
        keys.complain("tilt.refused_deg", "no more than 5: beyond, a tilt is not corrected well");
    if (pose.warned > pose.refused) keys.complain("tilt.warned_deg", "no more than refused_deg");
    if (pose.corrected > pose.refused)
        keys.complain("tilt.corrected_deg", "no more than refused_deg");
}

}  // namespace

Result<JudgingLimits> readLimits(const std::filesystem::path& file) {
    Result<TomlKeys> read = TomlKeys::read(file, kSchema);
    if (!read) return read.error();
    TomlKeys& keys = *read;
    JudgingLimits limits;
    limits.name = file.stem().string();
    readPose(keys, limits.pose);
    limits.lightStep = keys.positiveOr("light.refused", limits.lightStep);
    proc::QualityLimits& sample = limits.sample;
    readBoth(keys, "ambient", sample.ambient);
    readBoth(keys, "reciprocity", sample.reciprocity);
    readBoth(keys, "saturation", sample.saturation);
    sample.reciprocityChiSquare =
        keys.positiveOr("reciprocity.chi_square", sample.reciprocityChiSquare);
    sample.planeSymmetry = keys.positiveOr("symmetry.plane_warned", sample.planeSymmetry);
    sample.isotropy = keys.positiveOr("symmetry.isotropy_warned", sample.isotropy);
    sample.symmetryChiSquare = keys.positiveOr("symmetry.chi_square", sample.symmetryChiSquare);
    sample.repeatOutliers = keys.positiveOr("repeats.warned", sample.repeatOutliers);
    sample.softness = keys.positiveOr("softness.refused", sample.softness);
    sample.drift = keys.positiveOr("drift.warned", sample.drift);
    sample.energySure = keys.positiveOr("energy.refused_u", sample.energySure);
    sample.translucency = keys.positiveOr("translucency.refused", sample.translucency);
    sample.translucencySure = keys.positiveOr("translucency.refused_u", sample.translucencySure);
    keys.nothingElse();
    if (keys.error()) return *keys.error();
    return limits;
}

}  // namespace gonio::daemon
