#pragma once
// The states of a placement, each merged and binned in another thread while the next is captured.
// At most one is being processed: a second waits for it, and keeps the rig alive meanwhile. States
// are added up in the order in which they came, so that the sum is that of one after the other.

#include <optional>
#include <vector>

#include "daemon/alongside.h"
#include "daemon/measurement.h"
#include "proc/optics/binning.h"
#include "proc/optics/glare.h"
#include "proc/radiance/dark.h"
#include "proc/radiance/merge.h"

namespace gonio::daemon {

/// One state, merged and binned.
struct Processed {
    proc::CellSignal signal;
    proc::RawState raw;
    std::optional<LightStep> lightStep;
    Seconds compute{0};
};

/// What each state is processed with; all borrowed, and not changed while one is.
struct Processing {
    const proc::DarkLibrary& darks;
    const proc::Binning& binning;
    const proc::GlareFilter& glare;
    const proc::SensorNoise& noise;
    const Clock& clock;

    [[nodiscard]] Result<Processed> operator()(State state, const std::vector<Frame>& frames) const;
};

class Gathering {
public:
    /// `rig` is borrowed.
    Gathering(driver::Rig& rig, const Processing& processing);
    Gathering(const Gathering&) = delete;
    Gathering& operator=(const Gathering&) = delete;

    /// Begins to process a state's bracket; an error is that of the state before.
    Result<void> add(State state, std::vector<Frame> frames);
    /// All that was added, the last state waited for.
    Result<Captured> finish();

private:
    Result<void> settle();

    driver::Rig& rig_;
    const Processing processing_;
    Captured captured_;
    double chiSquare_ = 0, freedom_ = 0;
    State state_;  ///< that is being processed
    std::optional<Alongside<Processed>> running_;
};

}  // namespace gonio::daemon
