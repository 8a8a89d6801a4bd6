#include "daemon/references.h"

#include "proc/calibrate/reference_io.h"

namespace gonio::daemon {
namespace {

// A real white tile is 0.86 to 1.28 times 1/pi within the rig's range (DESIGN.md 5).
constexpr double kIdealWhiteUncertainty = 0.15;

}  // namespace

Result<References> loadReferences(const RigProfile& profile) {
    Result<proc::ReferenceTable> white =
        profile.whiteReference.empty()
            ? proc::ReferenceTable::lambertian("white", 1, kIdealWhiteUncertainty)
            : proc::readReference(profile.whiteReference);
    if (!white) return white.error();
    return References{
        .white = std::make_shared<const proc::ReferenceTable>(std::move(*white)),
        .black = std::make_shared<const proc::ReferenceTable>(proc::ReferenceTable::lambertian(
            "black", profile.blackReflectance, profile.blackRelativeUncertainty)),
        .zero = std::make_shared<const proc::ReferenceTable>(
            proc::ReferenceTable::lightTrap("zero", profile.zeroUncertainty))};
}

Result<References> loadReferences() {
    const Result<RigProfile> profile = readProfile(defaultProfile());
    if (!profile) return profile.error();
    return loadReferences(*profile);
}

}  // namespace gonio::daemon
