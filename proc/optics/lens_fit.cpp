#include "proc/optics/lens_fit.h"

#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"
#include "proc/solve/least_squares.h"

namespace gonio::proc {
namespace {

constexpr double kWorstDegrees = 0.5;

/// Steps for numerical derivatives, by parameter: about 1e-3 pixels at the rim each.
constexpr std::array<double, LensMap::kParameters> kSteps{
    1e-3, 1e-3, 2e-6, 2e-6, 2e-6, 2e-6, 2e-6, 2e-6};

}  // namespace

DirectionUncertainty::DirectionUncertainty(const LensFit& fit)
    : map_(fit.map), covariance_(fit.covariance) {
    for (std::size_t i = 0; i < LensMap::kParameters; ++i) {
        auto up = map_.values();
        auto down = map_.values();
        up[i] += kSteps[i];
        down[i] -= kSteps[i];
        slopes_.push_back({LensMap::fromValues(up), LensMap::fromValues(down), 2 * kSteps[i]});
    }
}

Radians DirectionUncertainty::operator()(const Direction& wo) const {
    const SensorPoint at = map_.pointOf(wo);
    Eigen::Matrix<double, 3, LensMap::kParameters> slopes;
    for (std::size_t i = 0; i < LensMap::kParameters; ++i) {
        const auto higher = slopes_[i].higher.directionAt(at);
        const auto lower = slopes_[i].lower.directionAt(at);
        if (!higher || !lower) return Radians(kPi);
        slopes.col(static_cast<Eigen::Index>(i)) =
            (higher->vector() - lower->vector()) / slopes_[i].width;
    }
    // The trace is the sum of both tangential variances.
    return Radians(std::sqrt(0.5 * (slopes * covariance_ * slopes.transpose()).trace()));
}

Result<LensFit> fitLens(std::span<const MirrorSpot> spots,
                        SensorPoint middle,
                        double pixelsPerDegree) {
    const auto start = LensMap::fTheta(middle, pixelsPerDegree).values();
    FitProblem problem;
    problem.start.assign(start.begin(), start.end());
    problem.residualCount = 2 * spots.size();
    problem.residuals = [&](std::span<const double> parameters, std::span<double> out) {
        const LensMap map = LensMap::fromValues(parameters);
        for (std::size_t i = 0; i < spots.size(); ++i) {
            const SensorPoint seen = map.pointOf(spots[i].direction);
            out[2 * i] = (seen.x - spots[i].at.x) / spots[i].sigma;
            out[2 * i + 1] = (seen.y - spots[i].at.y) / spots[i].sigma;
        }
        return true;
    };
    const FitReport report = fit(problem);
    if (!report.ok()) {
        return Error{ErrorKind::Quality,
                     "lens map: " + std::string(name(report.status)) + " with " +
                         std::to_string(spots.size()) +
                         " mirror spots; all placements of the mirror are needed"};
    }
    LensFit result{.map = LensMap::fromValues(report.params), .covariance = report.covariance};
    double squares = 0;
    double weighted = 0;
    for (const MirrorSpot& spot : spots) {
        const SensorPoint seen = result.map.pointOf(spot.direction);
        const double away = std::hypot(seen.x - spot.at.x, seen.y - spot.at.y);
        squares += away * away;
        weighted += away * away / (spot.sigma * spot.sigma);
        result.worstPixels = std::max(result.worstPixels, away);
    }
    result.rmsPixels = std::sqrt(squares / static_cast<double>(spots.size()));
    if (result.worstPixels > kWorstDegrees * pixelsPerDegree) {
        return Error{ErrorKind::Quality,
                     "lens map: a mirror spot lies " + fixed(result.worstPixels, 1) +
                         " pixels beside the map; was the mirror on the wedge that was asked for?"};
    }
    // Birge: spots that scatter more than their sigmas say widen the covariance.
    const double freedom =
        static_cast<double>(2 * spots.size()) - static_cast<double>(LensMap::kParameters);
    if (freedom > 0) result.covariance *= std::max(1.0, weighted / freedom);
    return result;
}

}  // namespace gonio::proc
