#pragma once
// Microfacets with a distribution of normals given as a table, isotropic [Ashikhmin2000]
// [Dupuy2015]:
//   f = D(h) G1(wi) G1(wo) F(wi.h) / (4 mu_i mu_o), G1(w) = mu / int D(m) max(0, w.m) dm,
// F by Schlick from f0. The table is D in any unit at angles theta_h from 0, rising, up to 90
// degrees; between them ln D is linear in theta_h (linear where a value is 0), beyond the last D =
// 0. It is scaled so that int D cos = 1. Reciprocal; single scattering.

#include <filesystem>
#include <memory>
#include <vector>

#include "proc/core/result.h"
#include "proc/models/fresnel.h"

namespace gonio::proc {

struct NormalTableRow {
    Radians thetaH;
    double d;
};

class NormalTable {
public:
    /// A File error for fewer than two rows, angles that do not rise from 0 to at most 90
    /// degrees, values that are negative or all zero.
    [[nodiscard]] static Result<NormalTable> make(std::vector<NormalTableRow> rows);
    /// CSV with the header `theta_h,d`: degrees, and D in any unit.
    [[nodiscard]] static Result<NormalTable> read(const std::filesystem::path& file);

    /// Normalised, 1/sr.
    [[nodiscard]] double d(double thetaH) const;
    /// 1/mu of a direction times G1: the inverse of the area projected towards it.
    [[nodiscard]] double maskedInverseMu(double mu) const;

private:
    explicit NormalTable(std::vector<NormalTableRow> rows);
    [[nodiscard]] double raw(double thetaH) const;
    [[nodiscard]] double projectedArea(double mu) const;

    std::vector<NormalTableRow> rows_;
    double scale_ = 1;
    std::vector<double> areas_;  ///< projected area at theta = i / (n - 1) of 90 degrees
};

template <class P>
struct Tabulated {
    std::shared_ptr<const NormalTable> table;  // read once for the float and the double kernel
    Bands<P> f0;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const double thetaH =
            std::atan2(std::sqrt(static_cast<double>(half.sin2)), static_cast<double>(half.h.z));
        const double lobe = table->d(thetaH) * 0.25 *
                            table->maskedInverseMu(static_cast<double>(pair.in.z)) *
                            table->maskedInverseMu(static_cast<double>(pair.out.z));
        return f0.each([&](const P& one) { return P(schlick(one, P(1), half.cosDiff) * P(lobe)); });
    }
};

}  // namespace gonio::proc
