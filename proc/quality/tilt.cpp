#include "proc/quality/tilt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "proc/quality/tilt_sightings.h"
#include "proc/solve/least_squares.h"

namespace gonio::proc {
namespace {

// rad. What is known of a normal without looking, as a rig is seated on its sample (a quarter of a
// degree), and what a fit may leave open at most (half a degree): beyond it tells nothing.
constexpr double kSeated = 0.0044, kWorstFit = 0.0087;
constexpr double kSteepest = 0.25;  // tan of the largest tilt that is looked for
constexpr int kMostIterations = 50;
constexpr double kGoodFit = 0.1;  // of what a lobe may be off: no other is looked for
// There is a lobe where it explains so much of chi-square.
constexpr double kLobeChiSquare = 50, kLobeGain = 1.05;
constexpr double kLeastShare = 0.3;  // of f in the mirror direction, under half of the LEDs

Direction normalOf(double x, double y) { return *Direction::fromVector({x, y, 1}); }

/// Parameters of the joint fit: n.x / n.z, n.y / n.z, ln alpha, ln f0.
Shape shapeOf(std::span<const double> p) { return {std::exp(p[2]), std::exp(p[3])}; }

constexpr double kNarrowest = 1e-3, kDimmest = 1e-3;

std::size_t countOf(const std::vector<Sightings>& leds) {
    std::size_t count = 0;
    for (const Sightings& led : leds) count += led.size();
    return count;
}

/// Of all LEDs, one after the other.
void residualsOf(const std::vector<Sightings>& leds,
                 const Shape& shape,
                 const Direction& normal,
                 std::span<double> out) {
    for (const Sightings& led : leds) {
        residualsOf(led, shape, normal, out.first(led.size()));
        out = out.subspan(led.size());
    }
}

FitReport fitJoint(const std::vector<Sightings>& leds, double alpha) {
    const auto residuals = [&](std::span<const double> p, std::span<double> out) {
        residualsOf(leds, shapeOf(p), normalOf(p[0], p[1]), out);
        return true;
    };
    return fit({.residuals = residuals,
                .residualCount = countOf(leds),
                .start = {0, 0, std::log(alpha), std::log(0.1)},
                .lower = {-kSteepest, -kSteepest, std::log(kNarrowest), std::log(kDimmest)},
                .upper = {kSteepest, kSteepest, 0, 0},
                .maxIterations = kMostIterations});
}

/// From where a fit ended without convergence, with f0 held there: a lobe hardly shows it, as the
/// LEDs' strengths are free.
FitReport fitHeld(const std::vector<Sightings>& leds, const std::vector<double>& from) {
    const auto residuals = [&](std::span<const double> p, std::span<double> out) {
        const std::array held{p[0], p[1], p[2], from[3]};
        residualsOf(leds, shapeOf(held), normalOf(p[0], p[1]), out);
        return true;
    };
    FitReport report = fit({.residuals = residuals,
                            .residualCount = countOf(leds),
                            .start = {from[0], from[1], from[2]},
                            .lower = {-kSteepest, -kSteepest, std::log(kNarrowest)},
                            .upper = {kSteepest, kSteepest, 0},
                            .maxIterations = kMostIterations});
    report.params.push_back(from[3]);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(4, 4);
    covariance.topLeftCorner(3, 3) = report.covariance;
    report.covariance = std::move(covariance);
    return report;
}

/// Sum of squared residuals where there is no lobe, only the floor.
double matt(const std::vector<Sightings>& leds) {
    double sum = 0;
    for (const Sightings& led : leds) {
        double ff = 0, f1 = 0, one1 = 0;
        for (const Sighting& one : led) {
            const double weight = 1 / (one.sigma * one.sigma);
            ff += weight * one.f * one.f;
            f1 += weight * one.f;
            one1 += weight;
        }
        if (one1 > 0) sum += ff - f1 * f1 / one1;
    }
    return sum;
}

/// A lobe of a usual width, of which nothing was found out.
FitReport noFit() {
    return {.params = {0, 0, std::log(0.2), std::log(0.1)},
            .covariance = Eigen::MatrixXd::Constant(4, 4, std::nan(""))};
}

/// From several widths, as a start too narrow or too wide does not see the lobe. Empty: there is
/// none; not ok: there is one, and no fit finds it.
std::optional<FitReport> bestJoint(const std::vector<Sightings>& leds) {
    std::optional<FitReport> best, unsettled;
    const auto better = [](const FitReport& report, const std::optional<FitReport>& than) {
        return std::isfinite(report.rms) && (!than || report.rms < than->rms);
    };
    for (double alpha : {0.05, 0.2, 0.5}) {
        FitReport report = fitJoint(leds, alpha);
        if (!report.ok()) {
            if (better(report, unsettled)) unsettled = std::move(report);
        } else if (better(report, best)) {
            best = std::move(report);
        }
        if (best && best->rms < kGoodFit) break;
    }
    if (!best && unsettled) {
        FitReport report = fitHeld(leds, unsettled->params);
        if (report.ok()) best = std::move(report);
    }
    const auto count = static_cast<double>(countOf(leds));
    const double left = best ? best->rms * best->rms * count : count;
    const double without = matt(leds);
    if (without - left < kLobeChiSquare || without < kLobeGain * left) return std::nullopt;
    return best ? best : noFit();
}

/// Root mean square of the relative misfit, beyond the noise, over the lobes of one LED.
double misfitOf(std::span<const Sighting> sightings,
                const TiltLobe& lobe,
                const Direction& normal) {
    const std::vector<Parts> parts = partsOf(sightings, {lobe.alpha, lobe.f0}, toSurface(normal));
    double squares = 0;
    int count = 0;
    for (std::size_t i = 0; i < sightings.size(); ++i) {
        const Sighting& one = sightings[i];
        if (!one.inLobe || !(one.f > 0)) continue;
        const double off = one.f - shownBy(lobe, parts[i]);
        squares += (off * off - one.u * one.u) / (one.f * one.f);
        ++count;
    }
    return std::sqrt(std::max(0.0, squares) / std::max(1, count));
}

/// By how far the cells really scatter about the fit.
TurnUncertainty uFitOf(const FitReport& report) {
    return {Radians(report.rms * std::sqrt(report.covariance(0, 0))),
            Radians(report.rms * std::sqrt(report.covariance(1, 1)))};
}

/// What a misfit may do to it.
Radians uMisfitOf(double misfit, double alpha) { return Radians(misfit * alpha / 4); }

/// With the lens map's part.
Normal uncertain(const Direction& normal,
                 const TurnUncertainty& uFit,
                 Radians uMisfit,
                 Radians uAngle) {
    const auto with = [&](Radians u) { return Radians(std::hypot(u.value(), uMisfit.value())); };
    const TurnUncertainty seen{with(uFit.towardX), with(uFit.towardY)};
    return {.direction = normal,
            .u = Radians(std::hypot(seen.larger().value(), uAngle.value())),
            .uSeen = seen};
}

/// One LED's own normal, and of its uncertainty what is the LED's alone: the lens map moves those
/// of all LEDs alike.
struct OwnNormal {
    Normal normal;
    TurnUncertainty uFit;
    Radians uMisfit;
};

/// The lobe's width is held.
std::optional<OwnNormal> normalSeenBy(std::span<const Sighting> sightings,
                                      const Shape& shape,
                                      const Normal& joint,
                                      Radians uAngle) {
    const auto residuals = [&](std::span<const double> p, std::span<double> out) {
        residualsOf(sightings, shape, normalOf(p[0], p[1]), out);
        return true;
    };
    const Direction& from = joint.direction;
    const FitReport report = fit({.residuals = residuals,
                                  .residualCount = sightings.size(),
                                  .start = {from.x() / from.z(), from.y() / from.z()},
                                  .lower = {-kSteepest, -kSteepest},
                                  .upper = {kSteepest, kSteepest},
                                  .maxIterations = kMostIterations});
    if (!report.ok()) return std::nullopt;
    const Direction own = normalOf(report.params[0], report.params[1]);
    const double misfit = misfitOf(sightings, strengths(sightings, shape, toSurface(own)), own);
    const TurnUncertainty uFit = uFitOf(report);
    const Radians uMisfit = uMisfitOf(misfit, shape.alpha);
    const Normal normal = uncertain(own, uFit, uMisfit, uAngle);
    if (normal.u.value() > kWorstFit) return std::nullopt;
    return OwnNormal{.normal = normal, .uFit = uFit, .uMisfit = uMisfit};
}

/// A lobe that stands out of its floor: less is the floor's own departure from Lambert's.
bool standsOut(const SampleSet& sample, const TiltEstimate& estimate) {
    std::size_t count = 0;
    for (std::size_t led = 0; led < sample.leds.size(); ++led) {
        const TiltLobe& lobe = estimate.lobes[led];
        const Direction wi = Direction::fromSpherical(sample.leds[led].incidence, Radians(0));
        const Parts parts =
            partsOf({lobe.alpha, lobe.f0}, Eigen::Matrix3d::Identity(), {wi, mirrorOf(wi)});
        const double there = lobe.specular * parts.lobe;
        if (there > kLeastShare * (there + lobe.diffuse * parts.floor)) ++count;
    }
    return 2 * count >= sample.leds.size();
}

double alongX(const Direction& normal) { return normal.x() / normal.z(); }
double alongY(const Direction& normal) { return normal.y() / normal.z(); }

/// What the LEDs' own normals differ by beyond their noise, root mean square. Along the plane of
/// incidence a lobe's lean is in it: there no more than across.
TurnUncertainty wavesOf(std::span<const std::optional<OwnNormal>> leds, const Direction& joint) {
    double x = 0, y = 0;  // of which noise may leave less than nothing
    int count = 0;
    for (const auto& led : leds) {
        if (!led) continue;
        const Eigen::Vector3d apart = led->normal.direction.vector() - joint.vector();
        const double misfit = 0.5 * std::pow(led->uMisfit.value(), 2);
        x += std::pow(apart.x(), 2) - std::pow(led->uFit.towardX.value(), 2) - misfit;
        y += std::pow(apart.y(), 2) - std::pow(led->uFit.towardY.value(), 2) - misfit;
        ++count;
    }
    const auto root = [&](double squares) {
        return Radians(count < 2 ? 0 : std::sqrt(std::max(0.0, squares / count)));
    };
    return {root(std::min(x, y)), root(y)};
}

/// The LED whose light comes from the normal, where no lobe's shape is taken for a tilt; empty
/// where none told its normal.
std::optional<std::size_t> atTheNormal(const SampleSet& sample,
                                       std::span<const std::optional<OwnNormal>> own) {
    for (std::size_t led = 0; led < own.size(); ++led) {
        if (own[led] && sample.leds[led].incidence < 5_deg) return led;
    }
    return std::nullopt;
}

/// How far the oblique LEDs put the normal along x from where LED `even` has it, root mean square,
/// beyond their noise.
double leanOfOblique(std::span<const std::optional<OwnNormal>> own, std::size_t even) {
    const OwnNormal& straight = *own[even];
    double squares = 0;
    int count = 0;
    for (std::size_t led = 0; led < own.size(); ++led) {
        if (led == even || !own[led]) continue;
        const double off = alongX(own[led]->normal.direction) - alongX(straight.normal.direction);
        squares += off * off - std::pow(own[led]->uFit.towardX.value(), 2) -
                   std::pow(straight.uFit.towardX.value(), 2);
        ++count;
    }
    return std::sqrt(std::max(0.0, squares) / std::max(1, count));
}

/// The joint normal, x weighted by inverse variance with that of the LED at the normal: the joint
/// fit's has the lean in it.
Normal evened(const Normal& joint,
              const TurnUncertainty& uFit,
              double lean,
              const OwnNormal& even,
              Radians uAngle) {
    const double fromAll = std::pow(uFit.towardX.value(), 2) + lean * lean;
    const double fromEven = std::pow(even.uFit.towardX.value(), 2);
    const double share = fromEven > 0 ? fromAll / (fromAll + fromEven) : 1;
    const double x = share * alongX(even.normal.direction) + (1 - share) * alongX(joint.direction);
    return uncertain(normalOf(x, alongY(joint.direction)),
                     {Radians(std::sqrt(share * fromEven)), uFit.towardY},
                     even.uMisfit,
                     uAngle);
}

/// There is a lobe, and how it lies is not to be seen.
TiltEstimate undetermined(TiltEstimate estimate) {
    estimate.determined = false;
    estimate.joint = {Direction(), Radians(kSeated), TurnUncertainty::even(Radians(kSeated))};
    estimate.leds.assign(estimate.lobes.size(), std::nullopt);
    return estimate;
}

}  // namespace

TiltEstimate seated(std::size_t leds) {
    const TiltLobe matt{.diffuse = 1, .specular = 0};
    return undetermined(
        {.joint = {}, .leds = {}, .lobes = std::vector(leds, matt), .waviness = {}});
}

double tiltedLobe(const TiltLobe& lobe, const Direction& normal, const LightView& pair) {
    return shownBy(lobe, toSurface(normal), pair);
}

std::optional<TiltEstimate> estimateTilt(const SampleSet& sample, Radians uAngle) {
    std::vector<Sightings> leds;
    leds.reserve(sample.leds.size());
    for (const LedTable& led : sample.leds) leds.push_back(sightingsOf(led));
    const std::optional<FitReport> report = bestJoint(leds);
    if (!report) return std::nullopt;
    const Shape shape = shapeOf(report->params);
    TiltEstimate estimate{.joint = {normalOf(report->params[0], report->params[1]), {}, {}},
                          .leds = {},
                          .lobes = {},
                          .waviness = {}};
    const Direction normal = estimate.joint.direction;
    for (const Sightings& led : leds) {
        estimate.lobes.push_back(strengths(led, shape, toSurface(normal)));
        const double misfit = misfitOf(led, estimate.lobes.back(), normal);
        estimate.misfit = std::max(estimate.misfit, misfit);
    }
    if (!standsOut(sample, estimate)) return std::nullopt;
    const TurnUncertainty uFit = uFitOf(*report);
    estimate.joint = uncertain(normal, uFit, uMisfitOf(estimate.misfit, shape.alpha), uAngle);
    std::vector<std::optional<OwnNormal>> own;
    for (const Sightings& led : leds) {
        own.push_back(normalSeenBy(led, shape, estimate.joint, uAngle));
        estimate.leds.push_back(own.back() ? std::optional(own.back()->normal) : std::nullopt);
    }
    if (const auto even = atTheNormal(sample, own)) {
        estimate.joint =
            evened(estimate.joint, uFit, leanOfOblique(own, *even), *own[*even], uAngle);
        for (std::size_t led = 0; led < leds.size(); ++led) {
            estimate.lobes[led] = strengths(leds[led], shape, toSurface(estimate.joint.direction));
        }
    }
    if (!(estimate.joint.u.value() <= kWorstFit)) return undetermined(std::move(estimate));
    estimate.waves = wavesOf(own, estimate.joint.direction);
    estimate.waviness =
        Radians(std::hypot(estimate.waves.towardX.value(), estimate.waves.towardY.value()));
    return estimate;
}

}  // namespace gonio::proc
