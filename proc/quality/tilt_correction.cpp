#include "proc/quality/tilt_correction.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "proc/core/parallel.h"
#include "proc/optics/cell_grid.h"
#include "proc/quality/cell_points.h"
#include "proc/table/sample_lookup.h"

namespace gonio::proc {
namespace {

/// One cell of one band, and what its LED sees of the fitted surface.
struct Place {
    std::size_t cell = 0;
    Band band = Band::R;
    LightView pair;
    const TiltLobe& lobe;
};

/// Applies `change(cells, place)` to all measured cells.
template <class Change>
void forEachCell(SampleSet& sample, const TiltEstimate& estimate, const Change& change) {
    for (std::size_t i = 0; i < sample.leds.size(); ++i) {
        LedTable& led = sample.leds[i];
        const Direction wi = Direction::fromSpherical(led.incidence, Radians(0));
        parallelFor(CellGrid::count(), [&](IndexRange cells) {
            for (std::size_t cell = cells.begin; cell < cells.end; ++cell) {
                for (const Band band : kBands) {
                    CellSamples& samples = led.bands[index(band)];
                    if (samples.size() == 0 || !samples.present(cell)) continue;
                    change(samples,
                           Place{cell, band, {wi, CellGrid::centre(cell)}, estimate.lobes[i]});
                }
            }
        });
    }
}

/// The mean over a cell of what the lobe shows there: in the middle of a cell a lobe of a few
/// degrees is another than over all of it.
double overCell(const Place& place, const Direction& normal) {
    const std::array<Direction, 4> points = pointsOver(place.cell);
    double sum = 0;
    for (const Direction& wo : points) sum += tiltedLobe(place.lobe, normal, {place.pair.in, wo});
    return sum / points.size();
}

void forget(CellSamples& cells, std::size_t cell) {
    cells.f[cell] = cells.uRandom[cell] = cells.uSystematic[cell] = std::nan("");
    cells.nEff[cell] = 0;
    cells.flags[cell].clear(Flag::Measured);
}

/// What a cell is missing for: what the cells are that it needs; without any, it is out of sight.
Flags lostBy(const Answer& needed) {
    Flags why;
    for (const Flag flag : {Flag::Saturated, Flag::BelowNoise, Flag::Blocked, Flag::BelowHorizon}) {
        if (needed.flags.has(flag)) why.set(flag);
    }
    return why == Flags{} ? Flags{Flag::Blocked} : why;
}

/// Of the normal that one LED sees: the joint one's, and the waves. `more` is added to either axis.
TurnUncertainty uOfOneLed(const TiltEstimate& estimate, Radians more = Radians(0)) {
    const auto with = [&](Radians u, Radians waves) {
        return Radians(std::hypot(u.value(), waves.value(), more.value()));
    };
    return {with(estimate.joint.uSeen.towardX, estimate.waves.towardX),
            with(estimate.joint.uSeen.towardY, estimate.waves.towardY)};
}

/// Adds what turns of u (k = 1) do to f, root mean square: by three points of a Gauss-Hermite rule
/// for each axis, which is the slope times u on a flank, and right where the top of a lobe has
/// none, too.
void widen(CellSamples& cells, const Place& place, const TurnUncertainty& u) {
    const double here = tiltedLobe(place.lobe, Direction(), place.pair);
    if (!(here > 0)) return;
    const double stepX = std::tan(std::numbers::sqrt3 * u.towardX.value());
    const double stepY = std::tan(std::numbers::sqrt3 * u.towardY.value());
    const auto off = [&](double x, double y) {
        return tiltedLobe(place.lobe, *Direction::fromVector({x, y, 1}), place.pair) / here - 1;
    };
    const double relative = std::hypot(std::hypot(off(stepX, 0), off(-stepX, 0)),
                                       std::hypot(off(0, stepY), off(0, -stepY))) /
                            std::sqrt(6.0);
    double& systematic = cells.uSystematic[place.cell];
    systematic = std::hypot(systematic, std::abs(cells.f[place.cell]) * relative);
}

/// Measured over fitted, cell by cell.
SampleSet quotients(SampleSet sample, const TiltEstimate& estimate) {
    forEachCell(sample, estimate, [&](CellSamples& cells, const Place& place) {
        const double fitted = overCell(place, estimate.joint.direction);
        if (!(fitted > 0)) return forget(cells, place.cell);
        cells.f[place.cell] /= fitted;
        cells.uRandom[place.cell] /= fitted;
        cells.uSystematic[place.cell] /= fitted;
    });
    return sample;
}

/// Where the rig sees the facet that a flat sample would show at this pair.
std::optional<Direction> seenAt(const LightView& pair, const Eigen::Matrix3d& turn) {
    const Eigen::Vector3d wi = pair.in.vector();
    const Eigen::Vector3d half = turn * (wi + pair.out.vector()).normalized();
    return Direction::fromVector(2 * half.dot(wi) * half - wi);
}

}  // namespace

SampleSet tiltCorrected(const SampleSet& sample, const TiltEstimate& estimate) {
    const SampleLookup smooth(quotients(sample, estimate));
    const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(
                                     Eigen::Vector3d::UnitZ(), estimate.joint.direction.vector())
                                     .toRotationMatrix();
    const TurnUncertainty u = uOfOneLed(estimate);
    SampleSet corrected = sample;
    forEachCell(corrected, estimate, [&](CellSamples& cells, const Place& place) {
        const auto at = seenAt(place.pair, turn);
        const Answer answer = at && at->aboveHorizon() ? smooth.answer({place.pair.in, *at})
                                                       : Answer::none({}, Source::Measured);
        if (!std::isfinite(answer.f[place.band])) {
            cells.flags[place.cell] = cells.flags[place.cell] | lostBy(answer);
            return forget(cells, place.cell);
        }
        const double flat = overCell(place, Direction());
        cells.f[place.cell] = answer.f[place.band] * flat;
        cells.uRandom[place.cell] = (*answer.uRandom)[place.band] * flat;
        cells.uSystematic[place.cell] = (*answer.uSystematic)[place.band] * flat;
        cells.flags[place.cell].set(Flag::TiltCorrected);
        widen(cells, place, u);
    });
    return corrected;
}

SampleSet withTiltUncertainty(SampleSet sample, const TiltEstimate& estimate) {
    const TurnUncertainty u = uOfOneLed(estimate, estimate.joint.tilt());
    forEachCell(
        sample, estimate, [&](CellSamples& cells, const Place& place) { widen(cells, place, u); });
    return sample;
}

}  // namespace gonio::proc
