#include "daemon/corrections.h"

namespace gonio::daemon {
namespace {

void divide(proc::CellSignal& signal, double by) {
    for (std::size_t cell = 0; cell < signal.size(); ++cell) {
        if (!signal.present(cell)) continue;
        signal.signal[cell] /= by;
        signal.variance[cell] /= by * by;
        signal.uGlare[cell] /= by;
        signal.flags[cell].set(Flag::DriftCorrected);
    }
}

}  // namespace

Result<void> fits(const Corrections& corrections, const Window& window) {
    if (!corrections.flat || corrections.flat->window == window) return {};
    return Error{ErrorKind::Quality,
                 "the flat field is of another window of the sensor; run: gonio calibrate flat"};
}

std::optional<double> lightOf(const proc::LedMonitor& leds,
                              Band band,
                              std::span<const proc::RawExposure> bracket) {
    double sum = 0, frames = 0;
    for (const proc::RawExposure& exposure : bracket) {
        const std::optional<double>& celsius = exposure.celsius[Frame::LedBoard];
        if (!celsius || !(exposure.milliamp > 0)) return std::nullopt;
        sum += exposure.frames * leds.light(band, {exposure.level, exposure.milliamp, *celsius});
        frames += exposure.frames;
    }
    if (!(frames > 0)) return std::nullopt;
    return sum / frames;
}

proc::CellSignal signalOf(const proc::RawState& state,
                          const Corrections& corrections,
                          const proc::GlareFilter& glare,
                          const proc::Binning& binning) {
    proc::CellSignal signal;
    if (corrections.flat) {
        proc::MergedState even = state.merged;
        (void)corrections.flat->apply(even);  // fits() was asked before
        signal = glare.bin(even, binning);
    } else {
        signal = glare.bin(state.merged, binning);
    }
    if (!corrections.leds) return signal;
    if (const auto light = lightOf(*corrections.leds, state.merged.band, state.bracket))
        divide(signal, *light);
    return signal;
}

}  // namespace gonio::daemon
