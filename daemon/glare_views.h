#pragma once
// The pictures of `calibrate mirror` that show the lens's glare: of the LED with the steepest
// light, green, a bracket in which the spot's surroundings are bright and the spot itself is dim,
// once where a wedge brings the spot nearest to the middle, once where the mirror lies flat, and
// once where a wedge sends the spot out of the field. The other bands are taken to be spread alike.

#include <optional>
#include <string>
#include <vector>

#include "daemon/measurement.h"
#include "daemon/sequencer.h"
#include "proc/optics/mirror.h"
#include "proc/radiance/merge.h"

namespace gonio::daemon {

class GlareViews {
public:
    /// `bench` is borrowed. LEDs at phi = 0.
    GlareViews(const std::vector<Radians>& leds, const Bench& bench);

    /// Brackets, each a step of progress; 0: no wedge sends this LED's spot out of the field.
    [[nodiscard]] int count() const;
    /// With the mirror on this wedge: takes its bracket where it is one of them.
    Result<void> take(const proc::Wedge& wedge,
                      Sequencer& sequencer,
                      const proc::DarkLibrary& darks);
    /// What the pictures say, once all wedges are through; empty, with a warning in the log, where
    /// they say nothing.
    [[nodiscard]] std::optional<proc::GlareSpread> spread(const proc::LensMap& map) const;

private:
    struct View {
        proc::Wedge wedge;
        std::optional<proc::MergedState> merged{};
    };
    const Bench& bench_;
    int led_ = 0;
    std::optional<View> unlit_;
    std::vector<View> lit_;
};

}  // namespace gonio::daemon
