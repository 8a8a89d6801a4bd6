#include "proc/estimate/albedo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/estimate/albedo_moments.h"
#include "proc/estimate/lobe_polar.h"
#include "proc/solve/gauss_kronrod.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kPanelEvaluations = 15 * 15;
/// Of values that sum up to 1 at the most, over some thousand nodes.
constexpr double kRounding = 1e-13;

/// An interval of one axis of a panel.
struct Side {
    double low = 0, high = 1;

    [[nodiscard]] double at(double share) const { return low + (high - low) * share; }
    [[nodiscard]] double length() const { return high - low; }
    [[nodiscard]] double middle() const { return (low + high) / 2; }
};

/// A rectangle of LobePolar's square with its integral and how far the coarser rule along either
/// axis is from it, band by band.
struct Panel {
    Side around, outward;
    AlbedoMoments value;
    std::array<double, 3> errorAround{}, errorOutward{};

    [[nodiscard]] double error(std::size_t band) const {
        return errorAround[band] + errorOutward[band];
    }
    [[nodiscard]] double worst() const { return std::max({error(0), error(1), error(2)}); }
    bool operator<(const Panel& other) const { return worst() < other.worst(); }
};

double largest(const std::array<double, 3>& bands) {
    return std::max({bands[0], bands[1], bands[2]});
}

/// All panels of one incidence; the one that errs most is on top of the heap.
class PanelSum {
public:
    PanelSum(const Scatterer& of, const Direction& wi) : of_(of), wi_(wi), polar_(wi) {
        for (int x = 0; x < LobePolar::kQuarters; ++x) {
            for (int y = 0; y < LobePolar::kRings; ++y) {
                push(integrated({double(x), double(x + 1)}, {double(y), double(y + 1)}));
            }
        }
    }

    void halveWorst() {
        std::pop_heap(panels_.begin(), panels_.end());
        const Panel worst = panels_.back();
        panels_.pop_back();
        const bool across = largest(worst.errorAround) > largest(worst.errorOutward);
        const Side& side = across ? worst.around : worst.outward;
        for (const Side& half : {Side{side.low, side.middle()}, Side{side.middle(), side.high}}) {
            push(across ? integrated(half, worst.outward) : integrated(worst.around, half));
        }
    }

    [[nodiscard]] AlbedoMoments total() const {
        AlbedoMoments sum;
        for (const Panel& panel : panels_) sum.add(1, panel.value);
        return sum;
    }
    [[nodiscard]] std::array<double, 3> error() const {
        std::array<double, 3> sum{kRounding, kRounding, kRounding};
        for (const Panel& panel : panels_) {
            for (std::size_t band = 0; band < 3; ++band) sum[band] += panel.error(band);
        }
        return sum;
    }
    [[nodiscard]] std::size_t evaluations() const { return evaluations_; }
    [[nodiscard]] const KnownUncertainty& known() const { return known_; }

private:
    void push(const Panel& panel) {
        panels_.push_back(panel);
        std::push_heap(panels_.begin(), panels_.end());
    }

    [[nodiscard]] AlbedoMoments momentsAt(const ProjectedNode& node) {
        const Answer answer = of_.answer({.in = wi_, .out = node.wo});
        return momentsOf(answer, node.wo.z(), known_);
    }

    [[nodiscard]] Panel integrated(const Side& around, const Side& outward) {
        const auto& nodes = gaussKronrod();
        std::array<Ring, 15> rings;
        for (std::size_t j = 0; j < nodes.size(); ++j) {
            rings[j] = LobePolar::ring(outward.at(nodes[j].x));
        }
        const double area = around.length() * outward.length();
        Panel panel{around, outward, {}, {}, {}};
        AlbedoMoments coarseAround, coarseOutward;
        for (const KronrodNode& x : nodes) {
            const Spoke spoke = polar_.spoke(around.at(x.x));
            AlbedoMoments fine, coarse;
            for (std::size_t j = 0; j < nodes.size(); ++j) {
                const ProjectedNode node = polar_.at(spoke, rings[j]);
                const AlbedoMoments moments = momentsAt(node);
                fine.add(area * nodes[j].kronrod * node.projected, moments);
                if (nodes[j].gauss > 0) {
                    coarse.add(area * nodes[j].gauss * node.projected, moments);
                }
            }
            panel.value.add(x.kronrod, fine);
            coarseAround.add(x.gauss, fine);
            coarseOutward.add(x.kronrod, coarse);
        }
        for (std::size_t band = 0; band < 3; ++band) {
            const double value = panel.value.of(AlbedoMoments::Light, band);
            panel.errorAround[band] = std::abs(value - coarseAround.of(AlbedoMoments::Light, band));
            panel.errorOutward[band] =
                std::abs(value - coarseOutward.of(AlbedoMoments::Light, band));
        }
        evaluations_ += kPanelEvaluations;
        return panel;
    }

    const Scatterer& of_;
    const Direction& wi_;
    LobePolar polar_;
    KnownUncertainty known_;
    std::vector<Panel> panels_;
    std::size_t evaluations_ = 0;
};

}  // namespace

Albedo directionalAlbedo(const Scatterer& of, const Direction& wi, const AlbedoOptions& options) {
    if (!wi.aboveHorizon()) return albedoOf({}, {}, {}, options.independentCell);
    PanelSum sum(of, wi);
    while (largest(sum.error()) > options.tolerance &&
           sum.evaluations() + 2 * kPanelEvaluations <= options.mostEvaluations) {
        sum.halveWorst();
    }
    Albedo albedo = albedoOf(sum.total(), sum.error(), sum.known(), options.independentCell);
    albedo.evaluations = sum.evaluations();
    albedo.converged = largest(sum.error()) <= options.tolerance;
    return albedo;
}

}  // namespace gonio::proc
