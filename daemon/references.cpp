#include "daemon/references.h"

#include "proc/calibrate/reference_io.h"

namespace gonio::daemon {

Result<References> loadReferences(const RigProfile& profile) {
    Result<proc::ReferenceTable> white = proc::readReference(profile.whiteReference);
    if (!white) return white.error();
    return References{
        .white = std::make_shared<const proc::ReferenceTable>(std::move(*white)),
        .black = std::make_shared<const proc::ReferenceTable>(proc::ReferenceTable::lambertian(
            "black", profile.blackReflectance, profile.blackRelativeUncertainty))};
}

Result<References> loadReferences() {
    const Result<RigProfile> profile = readProfile(defaultProfile());
    if (!profile) return profile.error();
    return loadReferences(*profile);
}

}  // namespace gonio::daemon
