#include "proc/calibrate/two_point.h"

#include <algorithm>
#include <array>
#include <atomic>
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
    ExposureRatio,
    NonLinearity,
    Geometry,
    LedDrift,
    Glare,  // from here on, Monte Carlo adds them as they are
    Pixels,
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
        {"exposure ratio", 'B', Correlation::PerState},
        {"linearity", 'B', Correlation::Common},
        {"direction of the cell (lens map)", 'A', Correlation::PerState},
        {"LED drift", 'B', Correlation::PerState},
        {"glare", 'B', Correlation::PerState},
        {"size of the pixels", 'B', Correlation::Common},
    };
}

double quadrature(const Contributions& u, std::size_t first, std::size_t behind) {
    double sum = 0;
    for (std::size_t i = first; i < behind; ++i) sum += u[i] * u[i];
    return std::sqrt(sum);
}

/// Median over the cells present of a signal's relative noise.
double medianNoise(const CellSignal& signal, const CellSamples& samples) {
    std::vector<double> relative;
    for (std::size_t cell = 0; cell < samples.size(); ++cell) {
        if (!samples.present(cell) || signal.signal[cell] == 0) continue;
        relative.push_back(std::sqrt(signal.variance[cell]) / std::abs(signal.signal[cell]));
    }
    return relative.empty() ? 0 : median(std::move(relative));
}

double medianDegrees(AngleUncertainty angle, const CellSamples& samples) {
    std::vector<double> degrees;
    for (std::size_t cell = 0; cell < samples.size(); ++cell) {
        if (samples.present(cell)) degrees.push_back(angle[cell].perAxis().degrees());
    }
    return degrees.empty() ? 0 : median(std::move(degrees));
}

/// What goes into the components, each in its unit.
void addSizes(Budget& budget,
              const CellSamples& samples,
              const CellSignal& sample,
              const References& references,
              const RigUncertainty& rig) {
    const Certificate& white = references.white.certificate();
    budget[SampleNoise].size = medianNoise(sample, samples);
    budget[WhiteNoise].size = medianNoise(references.whiteSignal, samples);
    budget[LowerNoise].size = medianNoise(references.blackSignal, samples);
    budget[WhiteCommon].size = white.uCommon;
    budget[WhitePerDirection].size = white.uPerDirection;
    budget[LowerCommon].size = references.black.certificate().uCommon;
    if (const double zero = references.black.certificate().uAbsolute; zero > 0) {
        budget[LowerCommon].size = zero;
        budget[LowerCommon].unit = "1/sr";
    }
    budget[ExposureRatio].size = rig.exposureRatio;
    budget[NonLinearity].size = rig.linearity;
    budget[Geometry].size = medianDegrees(rig.angle, samples);
    budget[Geometry].unit = "degree";
    budget[Geometry].freedom = rig.angleFreedom;
    budget[LedDrift].size = rig.ledDrift;
    budget[Pixels].size = Radians(std::sqrt(sample.pixelSolidAngle)).degrees();
    budget[Pixels].unit = "degree";
}

/// What the tiles' certificates say at a cell, 1/sr.
struct Certified {
    double fWhite = 0, fBlack = 0, uBlack = 0;
};

/// All that f of a state is made of.
struct Measurement {
    const CellSignal& sample;
    const References& references;
    const RigUncertainty& rig;
    const std::vector<Certified>& certified;  // of each cell

    /// Of a cell that is present in `samples`, where f and u_random are known.
    [[nodiscard]] CellInputs inputsOf(std::size_t cell, const CellSamples& samples) const {
        const Certificate& white = references.white.certificate();
        return {.sample = sample.signal[cell],
                .white = references.whiteSignal.signal[cell],
                .black = references.blackSignal.signal[cell],
                .sampleVariance = sample.variance[cell],
                .whiteVariance = references.whiteSignal.variance[cell],
                .blackVariance = references.blackSignal.variance[cell],
                .fWhite = certified[cell].fWhite,
                .fBlack = certified[cell].fBlack,
                .uWhite = std::hypot(white.uCommon, white.uPerDirection),
                .uBlack = certified[cell].uBlack,
                .uLight = std::hypot(rig.ledDrift, rig.exposureRatio, rig.linearity),
                .uAngle = rig.angle[cell],
                .uElse = 0,
                .shape = localShape(samples, cell)};
    }
};

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
                     const RigUncertainty& rig,
                     const MonteCarlo& monteCarlo) {
    const CellSignal& white = references.whiteSignal;
    const CellSignal& black = references.blackSignal;
    assert(sample.size() == CellGrid::count() && white.size() == sample.size() &&
           black.size() == sample.size());
    Calibrated result{.samples = CellSamples::missing(sample.size()), .budget = {}};
    CellSamples& out = result.samples;
    std::vector<Contributions> contributions(sample.size());
    std::vector<Certified> certified(sample.size());

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
            if (!(contrast > kMinContrastSigmas * noise)) {
                out.flags[cell].set(Flag::BelowNoise);
                continue;
            }

            certified[cell] = {.fWhite = certifiedWhite.f[band],
                               .fBlack = certifiedBlack.f[band],
                               .uBlack = (*certifiedBlack.uSystematic)[band]};
            const auto [fw, fb, uBlack] = certified[cell];
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
            u[LowerCommon] = std::abs(1 - q) * uBlack;
            const double byLight = std::abs(gain) * std::hypot(sample.signal[cell],
                                                               q * white.signal[cell],
                                                               (1 - q) * black.signal[cell]);
            u[ExposureRatio] = rig.exposureRatio * byLight;
            u[NonLinearity] = rig.linearity * byLight;
            u[LedDrift] = rig.ledDrift * byLight;
            u[Glare] = std::abs(gain) * std::hypot(sample.uGlare[cell],
                                                   q * white.uGlare[cell],
                                                   (1 - q) * black.uGlare[cell]);
            out.uRandom[cell] = quadrature(u, SampleNoise, WhiteCommon);
        }
    });
    // The slope needs the neighbours' f and noise.
    const Measurement measurement{sample, references, rig, certified};
    std::vector<double> uRandom = out.uRandom;
    std::atomic<std::size_t> propagated = 0;
    parallelFor(sample.size(), [&](IndexRange cells) {
        for (std::size_t cell = cells.begin; cell < cells.end; ++cell) {
            if (!out.present(cell)) continue;
            Contributions& u = contributions[cell];
            CellInputs inputs = measurement.inputsOf(cell, out);
            u[Geometry] = inputs.shape.firstOrder(out.f[cell], inputs.uAngle);
            u[Pixels] = std::abs(inputs.shape.laplacian(out.f[cell])) * sample.pixelSolidAngle / 12;
            out.uSystematic[cell] = quadrature(u, WhiteCommon, ComponentCount);
            const double total = std::hypot(out.uRandom[cell], out.uSystematic[cell]);
            if (monteCarlo.draws == 0 && !firstOrderFails(inputs, total)) continue;
            inputs.uElse = quadrature(u, Glare, ComponentCount);
            const int draws = monteCarlo.draws > 0 ? monteCarlo.draws : kAutomaticDraws;
            const PropagatedUncertainty better = propagate(inputs, draws, monteCarlo.seed + cell);
            uRandom[cell] = better.random;
            out.uSystematic[cell] = better.systematic;
            ++propagated;
        }
    });
    out.uRandom = std::move(uRandom);
    for (std::size_t cell = 0; cell < out.size(); ++cell) {
        if (out.present(cell) && std::abs(out.f[cell]) < 2 * out.uRandom[cell]) {
            out.flags[cell].set(Flag::BelowNoise);
        }
    }
    result.propagated = propagated;
    result.budget = summary(out, contributions, references.black.certificate().name);
    addSizes(result.budget, out, sample, references, rig);
    return result;
}

}  // namespace gonio::proc
