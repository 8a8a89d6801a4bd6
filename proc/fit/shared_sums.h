#pragma once
// The errors that values share (BrdfData::shared) in sums over residuals. All values of an
// incidence and band share one of standard uncertainty `state`, those of a patch of directions in
// it another of `patch`, both times v = m0 / u: m0 is the model of a fit without them. (The
// measured f in its place, whose noise it would share, makes a fit come out too small.) So the
// covariance of the residuals of an incidence and band is
//   C = 1 + patch^2 sum_p v_p v_p^T + state^2 v v^T,   v_p: v within patch p, 0 elsewhere,
// and by the rank-one inverse, twice (patches have no value in common),
//   B = 1 + patch^2 sum_p v_p v_p^T:  x^T B^-1 y = x.y - sum_p g_p patch^2 (x.v_p)(y.v_p),
//                                     g_p = 1 / (1 + patch^2 v_p.v_p),
//   x^T C^-1 y = x^T B^-1 y - state^2 (x^T B^-1 v)(y^T B^-1 v) / (1 + state^2 v^T B^-1 v),
//                                     x^T B^-1 v = sum_p g_p x.v_p.
// Nothing more is fitted, and no offset of an LED or of a patch counts as misfit beyond its
// uncertainty.

#include <array>
#include <cstddef>
#include <vector>

#include "proc/fit/brdf_data.h"
#include "proc/fit/family.h"

namespace gonio::proc {

/// Residuals and derivatives along v, or v_p.
struct AlongModel {
    double r = 0;
    double v = 0;
    std::array<double, kMostLocal> j{};
};

class SharedSums {
public:
    /// `wanted` false: as if nothing were shared.
    SharedSums(const BrdfData& data, bool wanted);

    /// One value: residual r, v, and derivatives by the first `local` parameters (as BandSlopes has
    /// them).
    void add(const FitRow& row,
             std::size_t band,
             double r,
             double v,
             const std::array<double, kMostLocal>& j = {},
             std::size_t local = 0) {
        if (patches_.empty()) return;
        AlongModel& to = patches_[placeOf(row.group, band) * kPatches + row.patch];
        to.r += r * v;
        to.v += v * v;
        for (std::size_t i = 0; i < local; ++i) to.j[i] += j[i] * v;
    }

    /// Calls visit(band, factor, along) for each term by which C^-1 falls short of 1:
    /// x^T C^-1 y = x.y - sum factor (x along)(y along).
    template <class Visit>
    void eachTaken(Visit&& visit) const {
        eachGroup([&](std::size_t band, const BudgetShare& share, const AlongModel* patches) {
            const double a = share.patch * share.patch;
            const double b = share.state * share.state;
            AlongModel all;
            for (std::size_t p = 0; p < kPatches; ++p) {
                const AlongModel& one = patches[p];
                if (one.v == 0) continue;
                const double g = 1 / (1 + a * one.v);
                visit(band, a * g, one);
                addTo(all, one, g);
            }
            visit(band, b / (1 + b * all.v), all);
        });
    }
    /// Likewise by which C exceeds 1.
    template <class Visit>
    void eachAdded(Visit&& visit) const {
        eachGroup([&](std::size_t band, const BudgetShare& share, const AlongModel* patches) {
            AlongModel all;
            for (std::size_t p = 0; p < kPatches; ++p) {
                if (patches[p].v == 0) continue;
                visit(band, share.patch * share.patch, patches[p]);
                addTo(all, patches[p], 1);
            }
            visit(band, share.state * share.state, all);
        });
    }
    /// r.r - r^T C^-1 r.
    [[nodiscard]] double taken() const;

private:
    static constexpr std::size_t kBandCount = 3;
    static std::size_t placeOf(std::size_t group, std::size_t band) {
        return group * kBandCount + band;
    }
    static void addTo(AlongModel& all, const AlongModel& one, double factor);
    template <class Visit>
    void eachGroup(Visit&& visit) const {
        if (patches_.empty()) return;
        for (std::size_t g = 0; g < shares_.size(); ++g) {
            for (std::size_t b = 0; b < kBandCount; ++b) {
                visit(b, shares_[g][b], patches_.data() + placeOf(g, b) * kPatches);
            }
        }
    }

    const BudgetShares& shares_;
    std::vector<AlongModel> patches_;  ///< by group, band, patch; empty: nothing is shared
};

}  // namespace gonio::proc
