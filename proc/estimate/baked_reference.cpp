#include <cmath>
#include <limits>

#include "proc/core/coordinates.h"
#include "proc/estimate/baked_table.h"

namespace gonio::proc {
namespace {

double asDouble(float value) { return value; }
double asDouble(Half16 value) { return toFloat(value); }

LedBands nodeAt(const BakedNodes& nodes, std::size_t i) {
    return std::visit(
        [i](const auto& all) {
            return LedBands{{asDouble(all[i].r), asDouble(all[i].g), asDouble(all[i].b)}};
        },
        nodes);
}

/// Along one axis: two nodes and their weights.
struct Edge {
    std::size_t low;
    double share;

    Edge(double at, int nodes) : low(0), share(0) {
        const double bounded = std::fmin(std::fmax(at, 0), nodes - 1);
        low = static_cast<std::size_t>(std::fmin(std::floor(bounded), nodes - 2));
        share = bounded - static_cast<double>(low);
    }
    [[nodiscard]] double weight(std::size_t corner) const {
        return corner == 0 ? 1 - share : share;
    }
};

/// c of a pair with these angles.
double skewOf(const LightView& pair, const HalfDifference& angles) {
    const double in = cos(pair.in.theta());
    const double out = cos(pair.out.theta());
    const double product = tan(angles.thetaHalf) * tan(angles.thetaDiff);
    const double q = std::abs(in - out) / (in + out);
    return product < 1 ? std::abs(cos(angles.phiDiff)) : std::fmin(1, q);
}

}  // namespace

LedBands evaluateReference(const BakedTable& table, const LightView& pair) {
    const LedBands none = LedBands::all(std::numeric_limits<double>::quiet_NaN());
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) return none;
    const auto angles = toHalfDifference(pair);
    if (!angles) return none;
    const BoxAxes& axes = table.axes();
    const BoxResolution& nodes = axes.resolution();
    const double octaves = std::log2(1 + BoxAxes::kMostTan / axes.t0());
    const Edge t(std::log2(1 + tan(angles->thetaHalf) / axes.t0()) / octaves * (nodes.tanHalf - 1),
                 nodes.tanHalf);
    const Edge m(std::sqrt(cos(angles->thetaDiff)) * (nodes.cosDiff - 1), nodes.cosDiff);
    const Edge c(skewOf(pair, *angles) * (nodes.skew - 1), nodes.skew);
    LedBands sum;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::size_t i = corner / 4, j = corner / 2 % 2, k = corner % 2;
        const std::size_t node =
            ((t.low + i) * static_cast<std::size_t>(nodes.cosDiff) + m.low + j) *
                static_cast<std::size_t>(nodes.skew) +
            c.low + k;
        sum = sum + nodeAt(table.nodes(), node) * (t.weight(i) * m.weight(j) * c.weight(k));
    }
    if (table.carrier() != nullptr) return sum * table.carrier()->answer(pair).f;
    for (double& value : sum.value) value = std::exp2(value);
    return sum;
}

}  // namespace gonio::proc
