#include "tests/study/coverage_repeat.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "daemon/references.h"
#include "daemon/sample_pose.h"
#include "proc/core/parallel.h"
#include "proc/models/spec.h"
#include "proc/quality/seen_direction.h"
#include "sim/light.h"

namespace gonio::study {
namespace {

constexpr Radians kField = 75_deg;
constexpr std::array<int, 2> kLeds{1, 3};  // at 20 and 60 degrees
constexpr int kSubdivisions = 8;           // of a cell, each way
constexpr Radians kTypicalView = 40_deg;

double f(const Scatterer& surface, const Direction& wi, Radians theta, Radians phi) {
    return surface.answer({.in = wi, .out = Direction::fromSpherical(theta, phi)}).f[kBand];
}

/// Over the solid angle of the cell: midpoints of equal areas.
double cellMean(const Scatterer& surface, const Direction& wi, std::size_t cell) {
    const proc::CellBounds at = proc::CellGrid::bounds(cell);
    const double top = cos(at.thetaLow), bottom = cos(at.thetaHigh);
    double sum = 0;
    for (int i = 0; i < kSubdivisions; ++i) {
        const Radians theta(std::acos(top + (bottom - top) * (i + 0.5) / kSubdivisions));
        for (int j = 0; j < kSubdivisions; ++j) {
            sum += f(surface,
                     wi,
                     theta,
                     at.phiLow + (at.phiHigh - at.phiLow) * ((j + 0.5) / kSubdivisions));
        }
    }
    return sum / (kSubdivisions * kSubdivisions);
}

/// Relative, per degree, at the cell's centre.
double slopeAt(const Scatterer& surface, const Direction& wi, std::size_t cell) {
    const Direction centre = proc::CellGrid::centre(cell);
    const Radians theta = centre.theta(), phi = centre.phi(), half = 0.5_deg;
    const Radians across(half.value() / sin(theta));
    return std::hypot(f(surface, wi, theta + half, phi) - f(surface, wi, theta - half, phi),
                      f(surface, wi, theta, phi + across) - f(surface, wi, theta, phi - across)) /
           f(surface, wi, theta, phi);
}

}  // namespace

const std::vector<Material>& materials() {
    static const std::vector<Material> all{
        {"black velvet", "lambert,albedo=0.001", false},
        {"dark paint", "oren-nayar,albedo=0.01,sigma=0.3", false},
        {"satin metal", "lambert,albedo=0.05+ggx,alpha=0.1,f0=0.9", true},
        {"gloss metal", "ggx,alpha=0.02,f0=0.9", true},
    };
    return all;
}

CoverageStudy::CoverageStudy(const sim::View& strip) : rig_(strip) {
    const auto references = daemon::loadReferences();
    if (!references) throw std::runtime_error(references.error().message);
    white_ = references->white;
    black_ = references->black;
    for (const Material& material : materials()) {
        auto surface = proc::makeModel(material.spec);
        if (!surface) throw std::runtime_error(surface.error().message);
        surfaces_.push_back(std::move(*surface));
        truths_.emplace_back();
        for (const int led : kLeds) truths_.back().push_back(truthOf(*surfaces_.back(), led));
    }
}

CoverageStudy::Truths CoverageStudy::truthOf(const Scatterer& surface, int led) const {
    const Direction wi = sim::ledDirection(led);
    Truths truths(proc::CellGrid::count());
    parallelFor(truths.size(), [&](IndexRange cells) {
        for (std::size_t cell = cells.begin; cell < cells.end; ++cell) {
            if (proc::CellGrid::bounds(cell).thetaHigh > kField + 0.1_deg) {
                truths[cell].f = std::numeric_limits<double>::quiet_NaN();
                continue;
            }
            truths[cell] = {cellMean(surface, wi, cell), slopeAt(surface, wi, cell)};
        }
    });
    return truths;
}

std::vector<Verdict> CoverageStudy::repeat(std::uint64_t seed) const {
    const Draw draw(seed);
    const proc::LensFit lens = rig_.lensMap(draw);
    const proc::DirectionUncertainty uAngle(lens);
    const proc::Binning binning(lens.map, rig_.window(), kField);
    const proc::DarkLibrary darks = rig_.darks(draw);
    std::uint64_t capture = 0;
    const auto tile = [&](sim::Role role, std::shared_ptr<const Scatterer> surface) {
        std::vector<proc::CellSignal> signals;
        const sim::Placement placement{.role = role, .surface = std::move(surface), .wedge = {}};
        for (const int led : kLeds) {
            signals.push_back(rig_.signal(placement, led, false, capture++, draw, darks, binning));
        }
        return signals;
    };
    const auto whites = tile(sim::Role::White, white_);
    const auto blacks = tile(sim::Role::Black, black_);

    std::vector<Radians> incidences;
    for (const int led : kLeds) incidences.push_back(sim::ledDirection(led).theta());
    std::vector<Verdict> verdicts;
    for (std::size_t m = 0; m < surfaces_.size(); ++m) {
        const sim::Placement placement{
            .role = sim::Role::Sample, .surface = surfaces_[m], .wedge = draw.tilt(m)};
        std::vector<proc::CellSignal> signals;
        for (const int led : kLeds) {
            signals.push_back(rig_.signal(
                placement, led, materials()[m].glossy, capture++, draw, darks, binning));
        }
        const auto calibrated = [&](const auto& uOf) {
            proc::SampleSet set;
            for (std::size_t i = 0; i < kLeds.size(); ++i) {
                const Direction wi = sim::ledDirection(kLeds[i]);
                std::vector<DirectionSpread> ofLed(proc::CellGrid::count());
                for (std::size_t cell = 0; cell < ofLed.size(); ++cell) {
                    if (signals[i].present(cell))
                        ofLed[cell] = uOf(i, proc::CellGrid::centre(cell));
                }
                proc::LedTable table{.incidence = wi.theta(), .bands = {}};
                table.bands[index(kBand)] = proc::calibrate(signals[i],
                                                            {.whiteSignal = whites[i],
                                                             .blackSignal = blacks[i],
                                                             .white = *white_,
                                                             .black = *black_},
                                                            wi,
                                                            kBand,
                                                            {.angle = ofLed, .ledDrift = kLedDrift})
                                                .samples;
                set.leds.push_back(std::move(table));
            }
            return set;
        };
        proc::SampleSet flat =
            calibrated([&](std::size_t, const Direction& wo) { return uAngle(wo); });
        // As `gonio measure` does it.
        auto tilt = proc::estimateTilt(
            flat, uAngle(Direction::fromSpherical(kTypicalView, Radians(0))).perAxis());
        if (daemon::worthCorrecting(tilt)) {
            const proc::SeenDirection seen(lens, incidences, *tilt);
            flat = calibrated(
                [&](std::size_t led, const Direction& wo) { return seen.uncertainty(led, wo); });
            tilt->waves = seen.wavesBeyondTheMap(*tilt);
        }
        flat = daemon::referredToItsNormal(std::move(flat), tilt);
        for (std::size_t i = 0; i < kLeds.size(); ++i) {
            const proc::CellSamples& cells = flat.leds[i].bands[index(kBand)];
            for (std::size_t cell = 0; cell < cells.size(); ++cell) {
                const Truth& truth = truths_[m][i][cell];
                if (!cells.present(cell) || !(truth.f > 0)) continue;
                verdicts.push_back({.truth = truth.f,
                                    .slopePerDegree = truth.slopePerDegree,
                                    .error = cells.f[cell] - truth.f,
                                    .u = std::hypot(cells.uRandom[cell], cells.uSystematic[cell]),
                                    .uRandom = cells.uRandom[cell]});
            }
        }
    }
    return verdicts;
}

CoverageRows CoverageStudy::run(std::uint64_t first, std::uint64_t count) const {
    std::vector<std::vector<Verdict>> repeats(count);
    parallelFor(count, [&](IndexRange mine) {
        for (std::size_t i = mine.begin; i < mine.end; ++i) repeats[i] = repeat(first + i);
    });
    CoverageRows rows;
    for (const std::vector<Verdict>& one : repeats) rows.add(one);
    return rows;
}

}  // namespace gonio::study
