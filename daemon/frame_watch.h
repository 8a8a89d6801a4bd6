#pragma once
// Whether pictures are what was asked for, though they came whole and with the right numbers
// (proc/quality/frame_check.h): each frame of a state against the one before it in that state's
// sums (its pilots come first), and the first of each capture against the light that it must show.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/rig_calibration.h"
#include "daemon/sequencer.h"
#include "proc/quality/verdict.h"
#include "proc/radiance/dark.h"

namespace gonio::daemon {

/// A frame that is not what was asked for.
struct OddFrame {
    State state;
    std::uint32_t number = 0;  ///< the rig's
    enum class Kind {
        Repeated,
        WithoutLight
    } kind = Kind::Repeated;
};

/// The mean light of a white reference, electrons per second and pixel of the window at full level;
/// by LED and band.
using WhiteRates = std::vector<std::array<double, 3>>;
[[nodiscard]] WhiteRates whiteRates(const PlacementSignals& white, const Window& window);

class FrameWatch {
public:
    /// Without white rates no frame is held against the light. `darks` is borrowed.
    FrameWatch(const proc::DarkLibrary& darks, const proc::SensorNoise& noise, WhiteRates white);

    void see(State state, const Frame& frame);
    [[nodiscard]] const std::vector<OddFrame>& odd() const { return odd_; }

private:
    [[nodiscard]] bool lacksLight(State state, const Frame& frame) const;

    const proc::DarkLibrary& darks_;
    proc::SensorNoise noise_;
    WhiteRates white_;
    std::optional<Frame> before_;
    std::vector<OddFrame> odd_;
};

/// `frames`: refused with a repeated one, warned with one that shows no light.
[[nodiscard]] proc::Verdict framesVerdict(std::span<const OddFrame> odd);

}  // namespace gonio::daemon
