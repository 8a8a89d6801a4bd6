#include "proc/models/directional_albedo.h"

#include <algorithm>
#include <cmath>

#include "proc/core/units.h"
#include "proc/models/masking.h"
#include "proc/solve/quadrature.h"

namespace gonio::proc {
namespace {

/// A node at a distance from the end that the nodes are drawn to.
struct DrawnNode {
    double distance;
    double weight;
};

/// x -> x^power draws the nodes of a rule to 0; tanh-sinh (power 1) does so at both ends by itself.
std::vector<DrawnNode> drawn(const std::vector<QuadratureNode>& nodes, double power) {
    std::vector<DrawnNode> all;
    for (const QuadratureNode& node : nodes) {
        const double slope = power * std::pow(node.x, power - 1);
        all.push_back({.distance = std::pow(node.x, power), .weight = node.weight * slope});
    }
    return all;
}

struct Rule {
    std::vector<DrawnNode> phi;  ///< from pi/2, to either side, in units of pi/2
    std::vector<DrawnNode> psi;  ///< from the horizon, in units of its psi
};

/// The powers at which 2 x 8 x 16 Gauss nodes err the least over the reference grid.
Rule gaussRule(std::size_t phi, std::size_t psi) {
    return {drawn(gaussLegendre(phi), 2.8), drawn(gaussLegendre(psi), 3.3)};
}

const Rule& ruleOf(Effort effort) {
    static const Rule draft = gaussRule(4, 8);
    static const Rule standard = gaussRule(8, 16);
    static const Rule reference{drawn(tanhSinh(56), 1), drawn(tanhSinh(56), 1)};
    switch (effort) {
        case Effort::Draft: return draft;
        case Effort::Standard: return standard;
        case Effort::Reference: break;
    }
    return reference;
}

/// One direction of the pair, with what is needed of it.
struct View {
    double alpha;
    double mu;
    double sine;
    double lambda;
};

/// The slope of the facet that sends the light along the horizon, and alpha tan(psi) at it.
double horizonSlope(const View& view, double cosPhi) {
    const double across = view.sine * cosPhi;
    const double root = std::sqrt(across * across + view.mu * view.mu);
    return cosPhi >= 0 ? (across + root) / view.mu : view.mu / (root - across);
}

struct Ring {
    double kept = 0;     ///< of E
    double schlick = 0;  ///< of B
    double blocked = 0;  ///< of 1 - E, above the horizon
};

/// The integral over psi at one phi.
Ring ringAt(const View& view, double cosPhi, const Rule& rule) {
    const double alpha = view.alpha;
    const double slopeMax = horizonSlope(view, cosPhi);
    const double psiMax = std::atan2(slopeMax, alpha);
    const double tangent = view.sine / view.mu;
    const double g1 = 1 / (1 + view.lambda);
    Ring ring;
    for (const DrawnNode& node : rule.psi) {
        const double rest = psiMax * node.distance;
        const double psi = psiMax - rest;
        const double sinPsi = std::sin(psi);
        const double cosPsi = std::cos(psi);
        const double slope = alpha * sinPsi / cosPsi;
        // mu_i = mu (Tmax - T)(T + 1/Tmax) / (1 + T^2), Tmax - T without a difference.
        const double toHorizon = alpha * std::sin(rest) / (cosPsi * std::cos(psiMax));
        const double length2 = 1 + slope * slope;
        const double muIn = std::min(1.0, view.mu * toHorizon * (slope + 1 / slopeMax) / length2);
        const double facing = 1 + slope * tangent * cosPhi;  // wo.h / (mu cos(theta_h))
        if (!(muIn > 0) || !(facing > 0)) continue;
        const double lambdaIn = ggxLambda(alpha * alpha * (1 - muIn) * (1 + muIn) / (muIn * muIn));
        const double weight = node.weight * psiMax * 2 * sinPsi * cosPsi * facing;
        const double g2 = 1 / (1 + lambdaIn + view.lambda);
        const double cosDiff = std::min(1.0, view.mu * facing / std::sqrt(length2));
        const double c = 1 - cosDiff;
        ring.kept += weight * g2;
        ring.schlick += weight * g2 * c * c * c * c * c;
        ring.blocked += weight * g1 * lambdaIn * g2;
    }
    return ring;
}

/// int 2 sin cos (1 + alpha tan(psi) t cos(phi)) dpsi from the horizon to where the facet turns
/// away from the viewer: all that leaves downward.
double belowHorizon(const View& view, double cosPhi) {
    const double tilt = view.alpha * view.sine / view.mu * cosPhi;
    const double from = std::atan2(horizonSlope(view, cosPhi), view.alpha);
    const double end = tilt < 0 ? std::atan(-1 / tilt) : kPi / 2;  // where 1 + tilt tan(psi) = 0
    const double span = end - from;
    if (!(span > 0)) return 0;
    // int 2 sin cos = sin(b - a) sin(b + a); int 2 sin^2 = (b - a) - sin(b - a) cos(b + a).
    const double sum = end + from;
    return std::sin(span) * std::sin(sum) + tilt * (span - std::sin(span) * std::cos(sum));
}

DirectionalAlbedo albedoBy(const Rule& rule, const AlbedoPoint& point) {
    View view{.alpha = point.alpha,
              .mu = point.mu,
              .sine = std::sqrt((1 - point.mu) * (1 + point.mu)),
              .lambda = 0};
    const double slope = view.alpha * view.sine / view.mu;
    view.lambda = ggxLambda(slope * slope);
    const double g1 = 1 / (1 + view.lambda);

    DirectionalAlbedo sum;
    for (const DrawnNode& node : rule.phi) {
        for (const double side : {1.0, -1.0}) {
            const double cosPhi = side * std::sin(kPi / 2 * node.distance);
            const Ring ring = ringAt(view, cosPhi, rule);
            const double weight = node.weight / 2;
            sum.e += weight * ring.kept;
            sum.b += weight * ring.schlick;
            sum.oneMinusE += weight * (ring.blocked + g1 * belowHorizon(view, cosPhi));
        }
    }
    sum.a = sum.e - sum.b;
    return sum;
}

}  // namespace

DirectionalAlbedo ggxAlbedo(const AlbedoPoint& point, Effort effort) {
    return albedoBy(ruleOf(effort), point);
}

AverageAlbedo ggxAverageAlbedo(double alpha, Effort effort) {
    AverageAlbedo average;
    const std::vector<QuadratureNode> nodes =
        effort == Effort::Reference ? tanhSinh(48) : gaussLegendre(32);
    for (const QuadratureNode& node : nodes) {
        const DirectionalAlbedo at = ggxAlbedo({.alpha = alpha, .mu = node.x}, effort);
        average.e += 2 * node.weight * node.x * at.e;
        average.oneMinusE += 2 * node.weight * node.x * at.oneMinusE;
    }
    return average;
}

namespace {

/// The cubic through the four nodes about x, of nodes at 0, 1/n, ... 1.
double between(const std::vector<double>& nodes, double x) {
    const auto cells = static_cast<double>(nodes.size() - 1);
    const double first = std::clamp(std::floor(x * cells) - 1, 0.0, cells - 3);
    const double s = x * cells - first;
    const double* y = nodes.data() + static_cast<std::size_t>(first);
    return y[0] * (1 - s) * (2 - s) * (3 - s) / 6 + y[1] * s * (2 - s) * (3 - s) / 2 +
           y[2] * s * (s - 1) * (3 - s) / 2 + y[3] * s * (s - 1) * (s - 2) / 6;
}

}  // namespace

// 1 - E is interpolated in x of mu = alpha sinh(x^3 asinh(1 / alpha)): close to mu = 0, where it
// goes like mu log(mu), and as close as the lobe needs where mu passes alpha. B is nearly (1 -
// mu)^5 E: what (1 - mu)^5 (1 - E) adds to it makes it smooth there, and it is interpolated in x of
// mu = x^3.
AlbedoCurve::AlbedoCurve(double alpha)
    : alpha_(std::max(alpha, kSmallestAlpha)), reach_(std::asinh(1 / alpha_)) {
    static const Rule rule = gaussRule(16, 40);
    lost_.push_back(0);
    schlick_.push_back(1);
    for (std::size_t i = 1; i <= kCells; ++i) {
        const double x = static_cast<double>(i) / static_cast<double>(kCells);
        const double cube = x * x * x;
        const double mu = std::min(1.0, alpha_ * std::sinh(cube * reach_));
        lost_.push_back(albedoBy(rule, {.alpha = alpha_, .mu = mu}).oneMinusE * scaleAt(mu));
        const DirectionalAlbedo at = albedoBy(rule, {.alpha = alpha_, .mu = cube});
        schlick_.push_back(at.b + at.oneMinusE * schlickWeight(cube));
    }
    for (const QuadratureNode& node : gaussLegendre(kCells)) {
        const double mu = node.x * node.x;  // draws the nodes to grazing
        average_.oneMinusE += node.weight * 2 * node.x * 2 * mu * oneMinusE(mu);
    }
    average_.e = 1 - average_.oneMinusE;
}

/// 1 - E falls like alpha^2 / mu^2 beyond the lobe: times this it is of order 1 everywhere.
double AlbedoCurve::scaleAt(double mu) const {
    return (mu * mu + alpha_ * alpha_) / (alpha_ * alpha_);
}

double AlbedoCurve::oneMinusE(double mu) const {
    const double x = std::cbrt(std::asinh(mu / alpha_) / reach_);
    return std::clamp(between(lost_, x) / scaleAt(mu), 0.0, 1.0);
}

DirectionalAlbedo AlbedoCurve::at(double mu) const {
    const double lost = oneMinusE(mu);
    const double schlick = between(schlick_, std::cbrt(mu)) - lost * schlickWeight(mu);
    const double b = std::clamp(schlick, 0.0, 1 - lost);
    return {.e = 1 - lost, .oneMinusE = lost, .a = 1 - lost - b, .b = b};
}

}  // namespace gonio::proc
