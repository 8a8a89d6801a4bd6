#include "proc/table/pair_distance.h"

#include <cmath>
#include <numbers>

namespace gonio::proc {
namespace {

constexpr double squared(double x) { return x * x; }

/// The components of a pair across the normal.
struct Across {
    double xi, yi, xo, yo;

    explicit Across(const LightView& pair)
        : xi(pair.in.x()), yi(pair.in.y()), xo(pair.out.x()), yo(pair.out.y()) {}

    /// conj(p_i) p_o: its phase is the azimuth from wi to wo.
    [[nodiscard]] double along() const { return xi * xo + yi * yo; }
    [[nodiscard]] double aside() const { return xi * yo - yi * xo; }
    [[nodiscard]] Across mirrored() const {
        Across other = *this;
        other.yi = -yi;
        other.yo = -yo;
        return other;
    }
};

double acrossDistance(const Across& a, const Across& b) {
    return squared(a.xi - b.xi) + squared(a.yi - b.yi) + squared(a.xo - b.xo) +
           squared(a.yo - b.yo);
}

/// a turned by the angle that brings it nearest to b.
Across turnedOnto(const Across& b, const Across& a) {
    const double re = a.xi * b.xi + a.yi * b.yi + a.xo * b.xo + a.yo * b.yo;
    const double im = a.xi * b.yi - a.yi * b.xi + a.xo * b.yo - a.yo * b.xo;
    const double length = std::sqrt(re * re + im * im);
    if (length == 0) return a;  // all turns are as good
    const double c = re / length;
    const double s = im / length;
    Across turned = a;
    turned.xi = c * a.xi - s * a.yi;
    turned.yi = s * a.xi + c * a.yi;
    turned.xo = c * a.xo - s * a.yo;
    turned.yo = s * a.xo + c * a.yo;
    return turned;
}

}  // namespace

double squaredDistance(const LightView& from, const LightView& to, PairSymmetry symmetry) {
    const double along = squared(from.in.z() - to.in.z()) + squared(from.out.z() - to.out.z());
    const Across a(from);
    const Across b(to);
    if (symmetry == PairSymmetry::None) return along + acrossDistance(a, b);
    // Of a pair and its mirror image the one on the other's side of the plane of incidence is
    // nearer.
    const bool mirror = symmetry == PairSymmetry::Plane && (a.aside() < 0) != (b.aside() < 0);
    return along + acrossDistance(turnedOnto(b, mirror ? a.mirrored() : a), b);
}

// With r^2 = |p_i|^2 + |p_o|^2 and the Hopf map n = (|p_i|^2 - |p_o|^2, 2 Re q, 2 Im q) / r^2 of
// q = conj(p_i) p_o, a unit vector: the least distance across the normal over all turns is
// r^2 + r'^2 - 2 r r' cos(a / 2), a the angle between n and n', that is
// (r - r')^2 + 4 r r' sin^2(a / 4). That of (sqrt(3) r, r n) / 2 is (r - r')^2 + r r' sin^2(a / 2),
// which is less by cos^2(a / 4) in its last term: at least one half.
PairPlace placeOf(const LightView& pair, PairSymmetry symmetry) {
    const Eigen::Vector3d& wi = pair.in.vector();
    const Eigen::Vector3d& wo = pair.out.vector();
    if (symmetry == PairSymmetry::None) return {wi.x(), wi.y(), wi.z(), wo.x(), wo.y(), wo.z()};
    const Across a(pair);
    const double in = squared(a.xi) + squared(a.yi);
    const double out = squared(a.xo) + squared(a.yo);
    const double r = std::sqrt(in + out);
    if (r == 0) return {wi.z(), wo.z(), 0, 0, 0, 0};
    const double aside = symmetry == PairSymmetry::Plane ? std::abs(a.aside()) : a.aside();
    return {wi.z(),
            wo.z(),
            std::numbers::sqrt3 / 2 * r,
            (in - out) / (2 * r),
            a.along() / r,
            aside / r};
}

}  // namespace gonio::proc
