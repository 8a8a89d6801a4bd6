#pragma once
// How much of the light from one direction a GGX surface of perfect mirrors (F = 1) sends back in
// one bounce, and the two numbers from which Schlick's Fresnel term is put together again:
//   E(mu) = integral of f cos(theta) over the hemisphere at F = 1,
//   A = integral of (1 - w) f cos, B = integral of w f cos, w = (1 - cos_d)^5: E = A + B, and
//   f0 A + f90 B is the albedo with Schlick's F. Height-correlated Smith masking; isotropic,
// alpha in [1e-7, 1], mu = cos(theta) in (0, 1]. All in [0, 1]. At mu -> 0 E tends to 1; E(1, 1) =
// 1 - ln 2.
//
// In slope-polar coordinates, tan(theta_h) = T = alpha tan(psi), phi about the plane of incidence,
//   E = 1/pi int_0^pi dphi int 2 sin(psi) cos(psi) (1 + T tan(theta) cos(phi)) G2 dpsi
// up to the exact horizon of the other direction, and what is lost,
//   1 - E = the same with G1 Lambda_i / (1 + Lambda_i + Lambda_o) in place of G2, plus all that
//   would leave below the horizon (in closed form over psi),
// is integrated by itself: it is 7e-6 at alpha 1e-3, where a difference would have lost it.
// Draft 64 evaluations (1e-3 of E, 2.3e-3 of A and B), standard 256 (1.5e-5), reference tanh-sinh
// (1e-11); all absolute.

#include <cstddef>
#include <vector>

#include "proc/core/effort.h"

namespace gonio::proc {

struct DirectionalAlbedo {
    double e = 0;
    double oneMinusE = 0;
    double a = 0;  ///< factor of f0
    double b = 0;  ///< factor of f90
};

struct AlbedoPoint {
    double alpha;
    double mu;
};

[[nodiscard]] DirectionalAlbedo ggxAlbedo(const AlbedoPoint& point, Effort effort);

/// 2 int E mu dmu over the hemisphere, and 1 minus it.
struct AverageAlbedo {
    double e = 0;
    double oneMinusE = 0;
};
[[nodiscard]] AverageAlbedo ggxAverageAlbedo(double alpha, Effort effort);

/// All of them for one alpha by interpolation between 129 nodes of mu: within 1e-6 of the reference
/// for mu >= 1e-4, alpha >= 1e-5. Below that alpha what is lost is under 1e-9 except at grazing,
/// and the curve of 1e-5 stands in.
class AlbedoCurve {
public:
    explicit AlbedoCurve(double alpha);

    [[nodiscard]] double oneMinusE(double mu) const;
    [[nodiscard]] DirectionalAlbedo at(double mu) const;
    [[nodiscard]] const AverageAlbedo& average() const { return average_; }

private:
    static constexpr double kSmallestAlpha = 1e-5;
    static constexpr std::size_t kCells = 128;

    [[nodiscard]] double scaleAt(double mu) const;

    double alpha_;
    double reach_;
    std::vector<double> lost_;
    std::vector<double> schlick_;
    AverageAlbedo average_;
};

}  // namespace gonio::proc
