#include "proc/table/klems_table.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

constexpr double kTurn = 360;
constexpr double kCentre = 1e-6;
/// Angles that went through radians are still the file's, in degrees.
constexpr double kSame = 1e-9;

double sineSquared(double degrees) {
    const double sine = sin(Radians::fromDegrees(degrees));
    return sine * sine;
}

/// Which ring a theta lies in.
std::optional<std::size_t> ringOf(const KlemsBasis& basis, double thetaDeg) {
    for (std::size_t i = 0; i < basis.rings.size(); ++i) {
        if (thetaDeg < basis.rings[i].upperDeg - kSame) return i;  // a border is the next ring's
    }
    const bool atRim = !basis.rings.empty() && thetaDeg <= basis.rings.back().upperDeg + kSame;
    return atRim ? std::optional(basis.rings.size() - 1) : std::nullopt;
}

double lowerOf(const KlemsBasis& basis, std::size_t ring) {
    return ring == 0 ? 0 : basis.rings[ring - 1].upperDeg;
}

}  // namespace

std::size_t KlemsBasis::patchCount() const {
    std::size_t count = 0;
    for (const Ring& ring : rings) count += ring.phis;
    return count;
}

std::optional<std::size_t> KlemsBasis::patchOf(Radians theta, Radians phi) const {
    const auto ring = ringOf(*this, theta.degrees());
    if (!ring) return std::nullopt;
    std::size_t first = 0;
    for (std::size_t i = 0; i < *ring; ++i) first += rings[i].phis;
    const auto phis = static_cast<double>(rings[*ring].phis);
    const double turns = phi.degrees() / kTurn;
    const double place = std::floor((turns - std::floor(turns)) * phis + 0.5);
    return first + static_cast<std::size_t>(place) % rings[*ring].phis;
}

bool KlemsBasis::isCentre(Radians theta, Radians phi) const {
    const auto ring = ringOf(*this, theta.degrees());
    if (!ring) return false;
    if (*ring == 0 && rings[0].phis == 1) return theta.degrees() <= kCentre;
    const double middle = (lowerOf(*this, *ring) + rings[*ring].upperDeg) / 2;
    const double step = kTurn / static_cast<double>(rings[*ring].phis);
    return std::abs(theta.degrees() - middle) <= kCentre &&
           std::abs(std::remainder(phi.degrees(), step)) <= kCentre;
}

double KlemsBasis::projectedSolidAngle(std::size_t patch) const {
    std::size_t ring = 0;
    for (; ring < rings.size() && patch >= rings[ring].phis; ++ring) patch -= rings[ring].phis;
    if (ring == rings.size()) return 0;
    return kPi * (sineSquared(rings[ring].upperDeg) - sineSquared(lowerOf(*this, ring))) /
           static_cast<double>(rings[ring].phis);
}

std::optional<KlemsBasis> knownKlemsBasis(const std::string& name) {
    static const std::vector<KlemsBasis> kKnown{
        {"LBNL/Klems Full",
         {{5, 1}, {15, 8}, {25, 16}, {35, 20}, {45, 24}, {55, 24}, {65, 24}, {75, 16}, {90, 12}}},
        {"LBNL/Klems Half",
         {{6.5, 1}, {19.5, 8}, {32.5, 12}, {46.5, 16}, {61.5, 20}, {76.5, 12}, {90, 4}}},
        {"LBNL/Klems Quarter", {{9, 1}, {27, 8}, {46, 12}, {66, 12}, {90, 8}}},
    };
    for (const KlemsBasis& basis : kKnown) {
        if (basis.name == name) return basis;
    }
    return std::nullopt;
}

std::vector<double> KlemsTable::hemispherical(const KlemsMatrix& matrix) const {
    const KlemsBasis& out = bases[matrix.outgoing];
    const std::size_t incident = bases[matrix.incident].patchCount();
    const std::size_t outgoing = out.patchCount();
    std::vector<double> sums(incident, 0);
    for (std::size_t patch = 0; patch < outgoing; ++patch) {
        const double angle = out.projectedSolidAngle(patch);
        for (std::size_t in = 0; in < incident; ++in) {
            sums[in] += angle * matrix.f[patch * incident + in];
        }
    }
    return sums;
}

const KlemsMatrix* KlemsTable::find(KlemsFace face,
                                    bool transmission,
                                    const std::string& spectrum) const {
    const auto found = std::find_if(matrices.begin(), matrices.end(), [&](const KlemsMatrix& m) {
        return m.face == face && m.transmission == transmission && m.spectrum == spectrum;
    });
    return found == matrices.end() ? nullptr : &*found;
}

}  // namespace gonio::proc
