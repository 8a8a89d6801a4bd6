#pragma once
// What lies between a merged picture and its signals: flat field, lens map, glare, and what the
// LEDs' light was worth. A raw capture holds the picture as it was merged, so that each of them can
// be exchanged afterwards.

#include <memory>
#include <optional>
#include <span>

#include "proc/formats/graw_exr.h"
#include "proc/optics/binning.h"
#include "proc/optics/glare.h"
#include "proc/radiance/flat_field.h"
#include "proc/radiance/led_monitor.h"

namespace gonio::daemon {

/// What can be put right where it was measured; each may be missing.
struct Corrections {
    std::shared_ptr<const proc::FlatField> flat{};
    std::optional<proc::LedMonitor> leds{};
};

/// Quality error where the flat field is of another window.
[[nodiscard]] Result<void> fits(const Corrections& corrections, const Window& window);

/// Light of a state's bracket over nominal: the mean over its frames. Empty where an exposure does
/// not tell its temperature of the LED board or its current.
[[nodiscard]] std::optional<double> lightOf(const proc::LedMonitor& leds,
                                            Band band,
                                            std::span<const proc::RawExposure> bracket);

/// A state's cells. With an LED monitor, where its light is told, they are those of nominal light,
/// and DriftCorrected.
[[nodiscard]] proc::CellSignal signalOf(const proc::RawState& state,
                                        const Corrections& corrections,
                                        const proc::GlareFilter& glare,
                                        const proc::Binning& binning);

}  // namespace gonio::daemon
