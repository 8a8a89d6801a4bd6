#include "daemon/corrections.h"

namespace gonio::daemon {
namespace {

constexpr std::size_t kLedBoard = 0;

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

double lightOf(const proc::LedMonitor& leds,
               Band band,
               std::span<const proc::RawExposure> bracket) {
    double sum = 0, frames = 0;
    for (const proc::RawExposure& exposure : bracket) {
        const std::optional<double>& celsius = exposure.celsius[kLedBoard];
        const double light =
            celsius ? leds.light(band, {exposure.level, exposure.milliamp, *celsius}) : 1;
        sum += light * exposure.frames;
        frames += exposure.frames;
    }
    return frames > 0 ? sum / frames : 1;
}

proc::CellSignal signalOf(const proc::RawState& state,
                          const Corrections& corrections,
                          const proc::GlareFilter& glare,
                          const proc::Binning& binning) {
    proc::CellSignal signal;
    if (corrections.flat) {
        proc::MergedState even = state.merged;
        corrections.flat->apply(even);
        signal = glare.bin(even, binning);
    } else {
        signal = glare.bin(state.merged, binning);
    }
    if (corrections.leds)
        divide(signal, lightOf(*corrections.leds, state.merged.band, state.bracket));
    return signal;
}

}  // namespace gonio::daemon
