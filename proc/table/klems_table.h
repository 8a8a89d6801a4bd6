#pragma once
// BSDF of a window layer on the patches of a Klems basis: rings of theta about the normal, each cut
// into equal azimuths, the first of which is centred on phi 0. A matrix holds the mean f in 1/sr
// for each pair of patches. Indices of a direction [S: Radiance's bsdf_m.c]:
//
//   outgoing  its own theta (from the normal of the side on which it lies) and phi;
//   incident  the light's theta, and its phi + 180, so that equal indices are the mirror direction
//   in
//             reflection and the straight continuation in transmission.
//
// The front is the side of our normal. Phi counts counter-clockwise seen from the front, for both
// faces; which of them WINDOW calls the outdoor side does not matter here.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proc/core/units.h"

namespace gonio::proc {

struct KlemsBasis {
    /// One ring, from the upper theta of the one before.
    struct Ring {
        double upperDeg = 0;
        std::size_t phis = 0;
        bool operator==(const Ring&) const = default;
    };
    std::string name;
    std::vector<Ring> rings;

    [[nodiscard]] std::size_t patchCount() const;
    /// Empty beyond the last ring.
    [[nodiscard]] std::optional<std::size_t> patchOf(Radians theta, Radians phi) const;
    /// Whether a direction is the middle of its patch, to 1e-6 degrees; the normal is that of the
    /// first ring where it is one patch.
    [[nodiscard]] bool isCentre(Radians theta, Radians phi) const;
    /// Integral of cos(theta) over a patch, sr; pi in all for a basis that goes to 90 degrees.
    [[nodiscard]] double projectedSolidAngle(std::size_t patch) const;
    bool operator==(const KlemsBasis&) const = default;
};

/// "LBNL/Klems Full", "Half", "Quarter"; empty for other names.
[[nodiscard]] std::optional<KlemsBasis> knownKlemsBasis(const std::string& name);

enum class KlemsFace : std::uint8_t {
    Front,
    Back
};

struct KlemsMatrix {
    KlemsFace face = KlemsFace::Front;  ///< on which the light falls
    bool transmission = false;
    std::string spectrum;                    ///< "Visible", "Solar", or a wavelength in nm
    std::string detector;                    ///< as the file names it
    std::size_t incident = 0, outgoing = 0;  ///< bases of the table
    std::vector<double> f;                   ///< 1/sr, outgoing > incident (fastest)
};

struct KlemsTable {
    std::vector<KlemsBasis> bases;
    std::vector<KlemsMatrix> matrices;

    [[nodiscard]] double at(const KlemsMatrix& matrix, std::size_t in, std::size_t out) const {
        return matrix.f[out * bases[matrix.incident].patchCount() + in];
    }
    /// Per incident patch, the fraction of its power that is scattered: the sum of f times the
    /// projected solid angle.
    [[nodiscard]] std::vector<double> hemispherical(const KlemsMatrix& matrix) const;
    /// The first of this kind; empty without any.
    [[nodiscard]] const KlemsMatrix* find(KlemsFace face,
                                          bool transmission,
                                          const std::string& spectrum) const;
};

}  // namespace gonio::proc
