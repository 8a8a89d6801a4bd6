#include "proc/optics/lens_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "proc/core/number_text.h"
#include "proc/solve/least_squares.h"

namespace gonio::proc {
namespace {

constexpr double kWorstDegrees = 0.5;

/// Steps for numerical derivatives, by parameter: about 1e-3 pixels at the rim each.
constexpr std::array<double, LensMap::kParameters> kSteps{
    1e-3, 1e-3, 2e-6, 2e-6, 2e-6, 2e-6, 2e-6, 2e-6};

/// The wedges of some spots, and what they are wrong by: two errors each, about x and about y, in
/// units of their tolerance.
class WedgeErrors {
public:
    WedgeErrors(std::span<const MirrorSpot> spots, Radians tolerance)
        : spots_(spots), tolerance_(tolerance) {
        std::map<Wedge, std::size_t> wedges;
        for (const MirrorSpot& spot : spots)
            wedgeOf_.push_back(wedges.try_emplace(spot.wedge, wedges.size()).first->second);
        if (tolerance > Radians()) count_ = 2 * wedges.size();
    }

    [[nodiscard]] std::size_t count() const { return count_; }

    /// Where spot `i` is seen when the wedges are wrong by this.
    [[nodiscard]] Direction direction(std::size_t i, std::span<const double> errors) const {
        Wedge wedge = spots_[i].wedge;
        if (count_ > 0) {
            wedge.aboutX = wedge.aboutX + tolerance_ * errors[2 * wedgeOf_[i]];
            wedge.aboutY = wedge.aboutY + tolerance_ * errors[2 * wedgeOf_[i] + 1];
        }
        return mirroredBy(wedge, spots_[i].light);
    }

private:
    std::span<const MirrorSpot> spots_;
    Radians tolerance_;
    std::vector<std::size_t> wedgeOf_;  // by spot
    std::size_t count_ = 0;
};

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

std::optional<DirectionSlopes> DirectionUncertainty::slopes(const Direction& wo) const {
    const SensorPoint at = map_.pointOf(wo);
    DirectionSlopes slopes;
    for (std::size_t i = 0; i < LensMap::kParameters; ++i) {
        const auto higher = slopes_[i].higher.directionAt(at);
        const auto lower = slopes_[i].lower.directionAt(at);
        if (!higher || !lower) return std::nullopt;
        slopes.col(static_cast<Eigen::Index>(i)) =
            (higher->vector() - lower->vector()) / slopes_[i].width;
    }
    return slopes;
}

DirectionSpread DirectionUncertainty::ofSlopes(const Direction& wo,
                                               const DirectionSlopes& slopes) const {
    const double phi = wo.phi().value();
    const Eigen::Vector3d alongPhi(-std::sin(phi), std::cos(phi), 0);
    const Eigen::Vector3d alongTheta = alongPhi.cross(wo.vector());
    const auto along = [&](const Eigen::Vector3d& axis) {
        const Eigen::RowVectorXd pull = axis.transpose() * slopes;
        return Radians(std::sqrt(std::max(0.0, (pull * covariance_ * pull.transpose()).value())));
    };
    return {.alongTheta = along(alongTheta), .alongPhi = along(alongPhi)};
}

DirectionSpread DirectionUncertainty::operator()(const Direction& wo) const {
    const std::optional<DirectionSlopes> known = slopes(wo);
    return known ? ofSlopes(wo, *known) : DirectionSpread::even(Radians(kPi));
}

Result<LensFit> fitLens(std::span<const MirrorSpot> spots,
                        SensorPoint middle,
                        double pixelsPerDegree,
                        Radians wedgeTolerance) {
    const WedgeErrors wedges(spots, wedgeTolerance);
    const auto start = LensMap::fTheta(middle, pixelsPerDegree).values();
    FitProblem problem;
    problem.start.assign(start.begin(), start.end());
    problem.start.resize(start.size() + wedges.count(), 0);
    problem.residualCount = 2 * spots.size() + wedges.count();
    problem.residuals = [&](std::span<const double> parameters, std::span<double> out) {
        const LensMap map = LensMap::fromValues(parameters.first(LensMap::kParameters));
        const auto errors = parameters.subspan(LensMap::kParameters);
        for (std::size_t i = 0; i < spots.size(); ++i) {
            const SensorPoint seen = map.pointOf(wedges.direction(i, errors));
            out[2 * i] = (seen.x - spots[i].at.x) / spots[i].sigma;
            out[2 * i + 1] = (seen.y - spots[i].at.y) / spots[i].sigma;
        }
        std::copy(errors.begin(), errors.end(), out.begin() + 2 * std::ssize(spots));
        return true;
    };
    const FitReport report = fit(problem);
    if (!report.ok()) {
        return Error{ErrorKind::Quality,
                     "lens map: " + std::string(name(report.status)) + " with " +
                         std::to_string(spots.size()) +
                         " mirror spots; all placements of the mirror are needed"};
    }
    const std::span<const double> found(report.params);
    constexpr auto kLens = static_cast<Eigen::Index>(LensMap::kParameters);
    LensFit result{.map = LensMap::fromValues(found.first(LensMap::kParameters)),
                   .covariance = report.covariance.topLeftCorner(kLens, kLens)};
    const auto errors = found.subspan(LensMap::kParameters);
    double squares = 0;
    double weighted = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
    for (std::size_t i = 0; i < spots.size(); ++i) {
        const MirrorSpot& spot = spots[i];
        const SensorPoint seen = result.map.pointOf(wedges.direction(i, errors));
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
    // Birge: spots that scatter more than their sigmas say widen the covariance. Each error brings
    // a residual, its tolerance, and a parameter.
    const double freedom =
        static_cast<double>(2 * spots.size()) - static_cast<double>(LensMap::kParameters);
    if (freedom > 0) result.covariance *= std::max(1.0, weighted / freedom);
    return result;
}

}  // namespace gonio::proc
