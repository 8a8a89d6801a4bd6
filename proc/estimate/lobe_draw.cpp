#include "proc/estimate/lobe_draw.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/parallel.h"
#include "proc/estimate/lobe_polar.h"
#include "proc/solve/quadrature.h"

namespace gonio::proc {
namespace {

constexpr double kLeastWeight = 0.01;

/// Where light goes: a node of LobePolar and f there.
struct LitNode {
    ProjectedNode node;
    double f = 0;  ///< mean of the bands, 1/sr
};

double meanAt(const Scatterer& of, const LightView& pair) {
    const LedBands f = of.answer(pair).f;
    const double mean = (f.value[0] + f.value[1] + f.value[2]) / 3;
    return std::isfinite(mean) ? mean : 0;
}

/// Over the whole hemisphere, 1536 of them.
std::vector<LitNode> litNodes(const Scatterer& of, const Direction& wi) {
    static const auto rule = gaussLegendre(8);
    const LobePolar polar(wi);
    std::vector<LitNode> nodes;
    for (int x = 0; x < LobePolar::kQuarters; ++x) {
        for (int y = 0; y < LobePolar::kRings; ++y) {
            for (const QuadratureNode& around : rule) {
                const Spoke spoke = polar.spoke(x + around.x);
                for (const QuadratureNode& outward : rule) {
                    ProjectedNode node = polar.at(spoke, LobePolar::ring(y + outward.x));
                    node.projected *= around.weight * outward.weight;
                    const double f = meanAt(of, {.in = wi, .out = node.wo});
                    nodes.push_back({node, f});
                }
            }
        }
    }
    return nodes;
}

/// Of each lobe alone at each node, lobe by lobe.
std::vector<std::vector<double>> densities(const LobeMixture& lobes,
                                           const Direction& wi,
                                           const std::vector<LitNode>& nodes) {
    std::vector<std::vector<double>> all;
    for (const WeightedLobe& one : lobes) {
        std::vector<double>& own = all.emplace_back();
        for (const LitNode& lit : nodes) {
            own.push_back(drawDensity({{1, one.lobe}}, {.in = wi, .out = lit.node.wo}));
        }
    }
    return all;
}

/// One step of expectation and maximisation: a lobe's new weight is its share of the light.
std::vector<double> improved(const std::vector<double>& weights,
                             const std::vector<std::vector<double>>& density,
                             const std::vector<LitNode>& nodes) {
    std::vector<double> next(weights.size(), 0.0);
    double light = 0;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
        const double here = std::max(0.0, nodes[j].f) * nodes[j].node.projected;
        double mixed = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) mixed += weights[k] * density[k][j];
        if (!(mixed > 0)) continue;
        light += here;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            next[k] += here * weights[k] * density[k][j] / mixed;
        }
    }
    if (!(light > 0)) return weights;
    for (double& weight : next) weight /= light;
    return next;
}

LobeMixture fitted(const Scatterer& of, const Direction& wi, LobeMixture lobes) {
    const std::vector<LitNode> nodes = litNodes(of, wi);
    const auto density = densities(lobes, wi, nodes);
    std::vector<double> weights(lobes.size(), 1.0 / static_cast<double>(lobes.size()));
    constexpr int kSteps = 60;
    for (int step = 0; step < kSteps; ++step) weights = improved(weights, density, nodes);
    for (std::size_t k = 0; k < lobes.size(); ++k) {
        lobes[k].weight = std::max(kLeastWeight, weights[k]);
    }
    return lobes;
}

}  // namespace

LobeMixture lobesAbout(double halfWidthTangent) {
    // D falls to 1/2 where 1 + (T / alpha)^2 is sqrt(2).
    const double alpha = halfWidthTangent / std::sqrt(std::sqrt(2.0) - 1);
    LobeMixture lobes{{}};
    for (const double times : {0.5, 1.0, 2.0, 4.0}) {
        const double own = std::clamp(times * alpha, 1e-6, 1.0);
        lobes.push_back({1, GgxLobe{Alpha<double>::isotropic(own)}});
        if (own == 1) break;
    }
    return lobes;
}

LobeDraw::LobeDraw(const Scatterer& of, const LobeMixture& lobes, std::size_t incidences)
    : mixtures_(std::max<std::size_t>(1, incidences)) {
    parallelFor(mixtures_.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const double mu =
                (static_cast<double>(i) + 0.5) / static_cast<double>(mixtures_.size());
            const Radians theta(std::atan2(std::sqrt((1 - mu) * (1 + mu)), mu));
            mixtures_[i] = fitted(of, Direction::fromSpherical(theta, Radians(0)), lobes);
        }
    });
}

const LobeMixture& LobeDraw::mixtureAt(const Direction& wi) const {
    const auto count = static_cast<double>(mixtures_.size());
    const double place = std::clamp(wi.z() * count, 0.0, count - 1);
    return mixtures_[static_cast<std::size_t>(place)];
}

std::optional<DrawnDirection> LobeDraw::draw(const Direction& wi, const Uniforms& random) const {
    const LobeMixture& mixture = mixtureAt(wi);
    const auto wo = drawDirection(mixture, wi, random);
    if (!wo) return std::nullopt;
    const double density = drawDensity(mixture, {.in = wi, .out = *wo});
    if (!(density > 0)) return std::nullopt;
    return DrawnDirection{*wo, density};
}

double LobeDraw::density(const LightView& pair) const {
    return drawDensity(mixtureAt(pair.in), pair);
}

double relativeVariance(const Scatterer& of, const Direction& wi, const LobeMixture& mixture) {
    double mean = 0, squares = 0;
    for (const LitNode& lit : litNodes(of, wi)) {
        const double density = drawDensity(mixture, {.in = wi, .out = lit.node.wo});
        mean += lit.f * lit.node.projected;
        if (density > 0) {
            squares += lit.f * lit.f * lit.node.wo.z() * lit.node.projected / density;
        }
    }
    if (!(mean > 0)) return std::numeric_limits<double>::quiet_NaN();
    return squares / (mean * mean) - 1;
}

}  // namespace gonio::proc
