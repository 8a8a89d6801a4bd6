#pragma once
// A scattered set in the order of its spherical coordinates theta_i, phi_i, theta_o, phi_o: samples
// that share the first ones (to 1e-9 rad) lie on a line along the next. It finds the neighbours of
// a pair along the axes, and how much each weighs in the linear interpolation between them.
//
// On each axis in turn it takes the nearest coordinate on either side of the pair's own that has an
// answer on the axes behind; between two, the weights are linear in the coordinate; of one alone
// (the other side has none within reach) all weight is its own, and at the pair's own coordinate
// too. On a full grid that is multilinear interpolation.
//
// Under isotropy phi_o counts from phi_i and phi_i is 0; under the plane's symmetry phi_o is folded
// into [0, pi]. At a normal incidence phi_i is 0: phi_o counts from +x there, as the LED's own side
// does in a measured sample. Distances along an azimuth are those on the sphere, phi sin(theta).

#include <array>
#include <span>
#include <vector>

#include "proc/core/direction.h"
#include "proc/table/scattered_set.h"

namespace gonio::proc {

/// How far along the axes is searched.
struct AxisReach {
    Radians incoming = 21_deg;  ///< theta_i and phi_i
    Radians outgoing = 10_deg;  ///< theta_o and phi_o
    /// At most so many coordinates and samples are looked at for one answer; what was found until
    /// then answers.
    std::size_t maxPoints = 256;
};

/// A sample, by its place among ids(), and its weight.
struct LineShare {
    std::size_t sample = 0;
    double weight = 0;
};

class SphericalLines {
public:
    explicit SphericalLines(const ScatteredSet& set);

    [[nodiscard]] PairSymmetry symmetry() const { return symmetry_; }
    /// Weights above 0, their sum 1; none where no sample is within reach.
    [[nodiscard]] std::vector<LineShare> sharesAt(const LightView& pair,
                                                  const AxisReach& reach) const;

private:
    using Coordinates = std::array<double, 4>;  ///< radians

    /// One coordinate of an axis: what shares it, along the next axis or, on the last, the samples.
    struct Branch {
        double at = 0;
        std::vector<Branch> next;
        std::vector<std::size_t> samples;
    };
    struct Ordered;
    struct Search;

    [[nodiscard]] Coordinates coordinatesOf(const LightView& pair) const;
    [[nodiscard]] static std::vector<Branch> branchesOf(std::span<Ordered> samples,
                                                        std::size_t axis);

    PairSymmetry symmetry_;
    std::vector<Branch> root_;
};

}  // namespace gonio::proc
