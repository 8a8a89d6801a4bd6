#include "proc/calibrate/two_point.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>

#include "proc/core/median.h"
#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

constexpr double kMinContrastSigmas = 5;

/// Absolute standard uncertainties of one cell, in 1/sr, in the order of components().
enum Component : std::size_t {
    SampleNoise,
    WhiteNoise,
    LowerNoise,
    WhiteCommon,
    WhitePerDirection,
    LowerCommon,
    Glare,
    Geometry,
    LedDrift,
    ComponentCount
};
using Contributions = std::array<double, ComponentCount>;

/// The components without their sizes; `lower`: "black" or "zero".
Budget components(const std::string& lower) {
    return {
        {"noise of the sample's frames", 'A', Correlation::PerCell},
        {"noise of the white reference's frames", 'A', Correlation::PerCell},
        {"noise of the " + lower + " reference's frames", 'A', Correlation::PerCell},
        {"white reference, common", 'B', Correlation::Common},
        {"white reference, per direction", 'B', Correlation::PerCell},
        {lower + " reference", 'B', Correlation::Common},
        {"glare", 'B', Correlation::PerState},
        {"direction of the cell (lens map)", 'A', Correlation::PerState},
        {"LED drift", 'B', Correlation::PerState},
    };
}

double quadrature(const Contributions& u, std::size_t first, std::size_t behind) {
    double sum = 0;
    for (std::size_t i = first; i < behind; ++i) sum += u[i] * u[i];
    return std::sqrt(sum);
}

/// |grad f| per radian at a cell, from its present neighbours; what is missing adds no slope.
double slope(const std::vector<double>& f, const std::vector<Flags>& flags, std::size_t cell) {
    const CellPlace at = CellGrid::place(cell);
    const Direction centre = CellGrid::centre(cell);
    const auto difference = [&](const std::optional<std::size_t>& a,
                                const std::optional<std::size_t>& b) {
        const std::size_t from = a && flags[*a].has(Flag::Measured) ? *a : cell;
        const std::size_t to = b && flags[*b].has(Flag::Measured) ? *b : cell;
        const double away = angleBetween({CellGrid::centre(from), CellGrid::centre(to)}).value();
        return away > 0 ? (f[to] - f[from]) / away : 0.0;
    };
    const auto inRow = [&](int row) -> std::optional<std::size_t> {
        if (row < 0 || row >= CellGrid::kRows) return std::nullopt;
        return CellGrid::cellAt(
            Direction::fromSpherical(Radians::fromDegrees(row + 0.5), centre.phi()));
    };
    const int sectors = CellGrid::sectors(at.row);
    const auto beside = [&](int step) -> std::optional<std::size_t> {
        return CellGrid::index({at.row, (at.sector + step + sectors) % sectors});
    };
    return std::hypot(difference(inRow(at.row - 1), inRow(at.row + 1)),
                      difference(beside(-1), beside(1)));
}

Budget summary(const CellSamples& samples,
               const std::vector<Contributions>& contributions,
               const std::string& lower) {
    Budget budget = components(lower);
    for (std::size_t i = 0; i < ComponentCount; ++i) {
        std::vector<double> relative;
        for (std::size_t cell = 0; cell < samples.size(); ++cell) {
            if (!samples.present(cell) || samples.f[cell] == 0) continue;
            relative.push_back(contributions[cell][i] / std::abs(samples.f[cell]));
        }
        budget[i].medianRelative = median(std::move(relative));
    }
    return budget;
}

}  // namespace

Calibrated calibrate(const CellSignal& sample,
                     const References& references,
                     const Direction& wi,
                     Band band,
                     const RigUncertainty& rig) {
    const CellSignal& white = references.whiteSignal;
    const CellSignal& black = references.blackSignal;
    assert(sample.size() == CellGrid::count() && white.size() == sample.size() &&
           black.size() == sample.size());
    Calibrated result{.samples = CellSamples::missing(sample.size()), .budget = {}};
    CellSamples& out = result.samples;
    std::vector<Contributions> contributions(sample.size());

    parallelFor(sample.size(), [&](IndexRange cells) {
        for (std::size_t cell = cells.begin; cell < cells.end; ++cell) {
            out.flags[cell] =
                (sample.flags[cell] | white.flags[cell] | black.flags[cell]).clear(Flag::Measured);
            if (!sample.present(cell) || !white.present(cell) || !black.present(cell)) continue;
            const LightView pair{.in = wi, .out = CellGrid::centre(cell)};
            const Answer certifiedWhite = references.white.answer(pair);
            const Answer certifiedBlack = references.black.answer(pair);
            if (!certifiedWhite.present() || !certifiedBlack.present()) continue;
            const double contrast = white.signal[cell] - black.signal[cell];
            const double noise = std::sqrt(white.variance[cell] + black.variance[cell]);
            if (!(contrast > kMinContrastSigmas * noise)) continue;

            const double fw = certifiedWhite.f[band];
            const double fb = certifiedBlack.f[band];
            const double q = (sample.signal[cell] - black.signal[cell]) / contrast;
            const double gain = (fw - fb) / contrast;  // df / dS
            out.f[cell] = fb + (fw - fb) * q;
            out.nEff[cell] = sample.nEff[cell];
            out.flags[cell].set(Flag::Measured);

            Contributions& u = contributions[cell];
            u[SampleNoise] = std::abs(gain) * std::sqrt(sample.variance[cell]);
            u[WhiteNoise] = std::abs(gain * q) * std::sqrt(white.variance[cell]);
            u[LowerNoise] = std::abs(gain * (1 - q)) * std::sqrt(black.variance[cell]);
            u[WhiteCommon] = std::abs(q * fw) * references.white.certificate().uCommon;
            u[WhitePerDirection] = std::abs(q * fw) * references.white.certificate().uPerDirection;
            u[LowerCommon] = std::abs(1 - q) * (*certifiedBlack.uSystematic)[band];
            u[Glare] = std::abs(gain) * std::hypot(sample.uGlare[cell],
                                                   q * white.uGlare[cell],
                                                   (1 - q) * black.uGlare[cell]);
            u[LedDrift] =
                rig.ledDrift * std::abs(gain) *
                std::hypot(
                    sample.signal[cell], q * white.signal[cell], (1 - q) * black.signal[cell]);
        }
    });
    // The slope needs the neighbours' f.
    parallelFor(sample.size(), [&](IndexRange cells) {
        for (std::size_t cell = cells.begin; cell < cells.end; ++cell) {
            if (!out.present(cell)) continue;
            Contributions& u = contributions[cell];
            u[Geometry] = slope(out.f, out.flags, cell) * rig.angle(CellGrid::centre(cell)).value();
            out.uRandom[cell] = quadrature(u, SampleNoise, WhiteCommon);
            out.uSystematic[cell] = quadrature(u, WhiteCommon, ComponentCount);
            if (std::abs(out.f[cell]) < 2 * out.uRandom[cell]) {
                out.flags[cell].set(Flag::BelowNoise);
            }
        }
    });
    result.budget = summary(out, contributions, references.black.certificate().name);
    return result;
}

}  // namespace gonio::proc
