#pragma once
// A reference tile as its certificate knows it: f per incidence, outgoing direction and band, and
// how wrong that may be. Bilinear between nodes in theta_o and |phi_o - phi_i| (a tile is
// isotropic, so 180..360 degrees mirrors 0..180); held constant beyond the last theta_o. Within 0.6
// degrees of a listed incidence that table is used, between two it is linear; beyond the listed
// ones by more than that there is no answer.

#include <string>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"

namespace gonio::proc {

/// What is known of a reference besides its table. Uncertainties are k = 1, relative to f where
/// they do not say otherwise.
struct Certificate {
    std::string name;
    std::string citation;
    std::string licence;
    double uCommon = 0;        ///< one error for all directions and bands
    double uPerDirection = 0;  ///< independent from direction to direction
    double uAbsolute = 0;      ///< one error for all directions and bands, 1/sr
};

/// f over theta_o x phi_o for one incidence.
struct ReferencePlane {
    Radians incidence;
    std::vector<Radians> theta;  ///< ascending, at least one
    std::vector<Radians> phi;    ///< ascending, from the light's azimuth, within [0, 180 degrees]
    std::vector<LedBands> f;     ///< [theta][phi], 1/sr
};

class ReferenceTable : public Scatterer {
public:
    /// File error when there is no plane, or one is not rectangular, not ascending, or holds a
    /// value that is not a finite number above 0.
    [[nodiscard]] static Result<ReferenceTable> make(Certificate certificate,
                                                     std::vector<ReferencePlane> planes);
    /// f = reflectance / pi in all directions: a uniform black, or the stated fallback for a white
    /// without a table.
    [[nodiscard]] static ReferenceTable lambertian(const std::string& name,
                                                   double reflectance,
                                                   double relativeUncertainty);

    /// f = 0 in all directions, known to `uAbsolute`, 1/sr: a zero reference.
    [[nodiscard]] static ReferenceTable lightTrap(const std::string& name, double uAbsolute);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] const Certificate& certificate() const { return certificate_; }
    [[nodiscard]] const std::vector<ReferencePlane>& planes() const { return planes_; }

private:
    ReferenceTable(Certificate certificate, std::vector<ReferencePlane> planes)
        : certificate_(std::move(certificate)), planes_(std::move(planes)) {}
    Certificate certificate_;
    std::vector<ReferencePlane> planes_;  // by ascending incidence
    bool everywhere_ = false;             // one plane for all incidences
};

}  // namespace gonio::proc
