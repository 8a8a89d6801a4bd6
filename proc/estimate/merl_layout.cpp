#include "proc/estimate/merl_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "proc/core/coordinates.h"
#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

constexpr int kHalf = 90, kDiff = 90, kPhi = 180;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct MerlNode {
    int half, diff, phi;

    [[nodiscard]] std::size_t number() const {
        return static_cast<std::size_t>(
            (std::min(half, kHalf - 1) * kDiff + std::min(diff, kDiff - 1)) * kPhi + phi % kPhi);
    }
};

LightView pairAt(const MerlNode& node) {
    const double root = static_cast<double>(node.half) / kHalf;
    return fromHalfDifference({.thetaHalf = Radians::fromDegrees(90 * root * root),
                               .phiHalf = Radians(0),
                               .thetaDiff = Radians::fromDegrees(node.diff),
                               .phiDiff = Radians::fromDegrees(node.phi)});
}

/// In nodes along each axis, not whole.
struct MerlPlace {
    double half, diff, phi;

    explicit MerlPlace(const HalfDifference& angles)
        : half(kHalf * std::sqrt(angles.thetaHalf.degrees() / 90)),
          diff(angles.thetaDiff.degrees()),
          phi(std::fmod(angles.phiDiff.degrees(), 180)) {}
};

}  // namespace

MerlLayout::MerlLayout(const Scatterer& truth) {
    constexpr std::size_t kNodes = std::size_t{kHalf} * kDiff * kPhi;
    for (auto& plane : planes_) plane.assign(kNodes, kNan);
    parallelFor(kNodes, [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const int number = static_cast<int>(i);
            const LightView pair =
                pairAt({number / (kDiff * kPhi), number / kPhi % kDiff, number % kPhi});
            const LedBands f = truth.answer(pair).f;
            for (std::size_t band = 0; band < 3; ++band) planes_[band][i] = f.value[band];
        }
    });
}

LedBands MerlLayout::evaluate(const LightView& pair, MerlLookup how) const {
    const LedBands none = LedBands::all(kNan);
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) return none;
    const auto angles = toHalfDifference(pair);
    if (!angles) return none;
    const MerlPlace at(*angles);
    if (how == MerlLookup::Nearest) {
        const std::size_t node = MerlNode{static_cast<int>(std::lround(at.half)),
                                          static_cast<int>(std::lround(at.diff)),
                                          static_cast<int>(std::lround(at.phi))}
                                     .number();
        return {{planes_[0][node], planes_[1][node], planes_[2][node]}};
    }
    const MerlNode low{
        static_cast<int>(at.half), static_cast<int>(at.diff), static_cast<int>(at.phi)};
    const auto weightOf = [](double place, int from, int step) {
        const double share = place - from;
        return step == 0 ? 1 - share : share;
    };
    LedBands sum;
    double total = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int i = corner / 4, j = corner / 2 % 2, k = corner % 2;
        const std::size_t node = MerlNode{low.half + i, low.diff + j, low.phi + k}.number();
        if (std::isnan(planes_[0][node])) continue;
        const double weight = weightOf(at.half, low.half, i) * weightOf(at.diff, low.diff, j) *
                              weightOf(at.phi, low.phi, k);
        sum = sum + LedBands{{planes_[0][node], planes_[1][node], planes_[2][node]}} * weight;
        total += weight;
    }
    return total > 0 ? sum * (1 / total) : none;
}

}  // namespace gonio::proc
