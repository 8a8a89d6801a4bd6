#include "daemon/capture_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/finest_binning.h"
#include "proc/plan/prediction.h"

namespace gonio::daemon {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kMostFrames = 256;  // of one capture

proc::RigTiming timingOf(const driver::RigInfo& rig, const RigProfile& profile) {
    proc::RigTiming timing =
        profile.cameraUsb == 3 ? proc::RigTiming::usb3() : proc::RigTiming::usb2();
    timing.framePeriod = Seconds(rig.framePeriod);
    timing.transfer = std::min(timing.transfer, timing.framePeriod);
    timing.ledSettle = std::chrono::milliseconds(rig.ident.ledSettleMs);
    return timing;
}

/// Of one pixel of the pictures: a binned one, the mean of its members, has the noise of one with
/// all their electrons.
proc::SensorNoise noiseOfPixel(proc::SensorNoise noise, int binning) {
    const int members = binning * binning;
    noise.electronsPerDn *= members;
    noise.readNoiseElectrons *= binning;
    noise.darkElectronsPerSecond *= members;
    return noise;
}

/// Of one state. NaN where nothing is known.
Responsivities::Cells responsivitiesOf(const proc::References& references,
                                       const Direction& wi,
                                       Band band) {
    const std::size_t count = proc::CellGrid::count();
    Responsivities::Cells cells{.signalPerF = std::vector(count, kNaN),
                                .dark = std::vector(count, kNaN)};
    const proc::CellSignal& white = references.whiteSignal;
    const proc::CellSignal& black = references.blackSignal;
    for (std::size_t cell = 0; cell < count; ++cell) {
        const LightView pair{.in = wi, .out = proc::CellGrid::centre(cell)};
        const Answer bright = references.white.answer(pair);
        const Answer dark = references.black.answer(pair);
        if (!bright.present() || !dark.present()) continue;
        if (!white.present(cell) || !black.present(cell)) continue;
        const double contrast = white.signal[cell] - black.signal[cell];
        const double perF = contrast / (bright.f[band] - dark.f[band]);
        if (!(perF > 0)) continue;
        cells.signalPerF[cell] = perF;
        cells.dark[cell] = black.signal[cell] - dark.f[band] * perF;
    }
    return cells;
}

}  // namespace

proc::RigModel rigModel(const driver::RigInfo& rig,
                        const RigProfile& profile,
                        double sensorCelsius) {
    const proc::SensorNoise noise = noiseOfPixel(profile.noise, finestBinning(rig.limits));
    proc::RigModel model{.sensor = {.noise = noise,
                                    .blackDn = static_cast<double>(rig.blackLevel),
                                    .fullWellElectrons = noise.fullScaleDn * noise.electronsPerDn,
                                    .celsius = sensorCelsius},
                         .timing = timingOf(rig, profile),
                         .levels = {1},
                         .exposures = {},
                         .maxFrames = std::min(rig.maxFrames, kMostFrames)};
    model.levels.insert(model.levels.end(), profile.dimLevels.begin(), profile.dimLevels.end());
    for (const Microseconds exposure : profile.exposures) model.exposures.emplace_back(exposure);
    return model;
}

proc::SystematicFloor floorOf(const RigReferences& references) {
    const proc::References first = referencesOf(references, {});
    const proc::Certificate& white = first.white.certificate();
    const RigProfile& profile = references.profile;
    const double byLight = std::sqrt(2.0);  // of the sample's capture and the white's
    const double lower = references.zero != nullptr
                             ? profile.zeroUncertainty
                             : profile.blackReflectance / kPi * profile.blackRelativeUncertainty;
    return proc::SystematicFloor({
        {"white reference, common", proc::Correlation::Common, white.uCommon, 0},
        {"white reference, per direction", proc::Correlation::PerCell, white.uPerDirection, 0},
        {"LED drift", proc::Correlation::PerState, byLight * profile.ledDrift, 0},
        {"exposure ratio", proc::Correlation::PerState, byLight * profile.exposureRatio, 0},
        {"linearity", proc::Correlation::Common, byLight * profile.linearity, 0},
        {first.black.certificate().name + " reference", proc::Correlation::Common, 0, lower},
    });
}

Responsivities::Responsivities(const RigReferences& references,
                               const std::vector<Radians>& ledAngles)
    : leds_(ledAngles.size()) {
    for (std::size_t led = 0; led < leds_.size(); ++led) {
        const Direction wi = Direction::fromSpherical(ledAngles[led], Radians(0));
        for (const Band band : kBands) {
            leds_[led][index(band)] =
                responsivitiesOf(referencesOf(references, {static_cast<int>(led), band}), wi, band);
        }
    }
}

proc::Responsivity Responsivities::of(State state) const {
    const Cells& cells = leds_[static_cast<std::size_t>(state.led)][index(state.band)];
    return {.signalPerF = cells.signalPerF, .dark = cells.dark};
}

proc::Prediction achieved(const PlacementSignals& signals,
                          const Responsivities& responsivities,
                          const proc::SystematicFloor& floor,
                          double fMin) {
    std::vector<proc::Counted> random, systematic, total;
    for (std::size_t led = 0; led < signals.size(); ++led) {
        for (const Band band : kBands) {
            const proc::CellSignal& signal = signals[led][index(band)];
            const proc::Responsivity means =
                responsivities.of({.led = static_cast<int>(led), .band = band});
            for (std::size_t cell = 0; cell < signal.size(); ++cell) {
                if (!signal.present(cell)) continue;
                const double light = signal.signal[cell] - means.dark[cell];
                const double f = light / means.signalPerF[cell];
                if (!(f >= fMin)) continue;
                const double uRandom = std::sqrt(signal.variance[cell]) / light;
                const double uSystematic = floor.at(f) / f;
                random.push_back({uRandom});
                systematic.push_back({uSystematic});
                total.push_back({std::hypot(uRandom, uSystematic)});
            }
        }
    }
    const std::size_t cells = random.size();
    return {.random = proc::spreadOf(std::move(random)),
            .systematic = proc::spreadOf(std::move(systematic)),
            .total = proc::spreadOf(std::move(total)),
            .cramerRao = {kNaN, kNaN, kNaN},
            .cells = cells};
}

}  // namespace gonio::daemon
