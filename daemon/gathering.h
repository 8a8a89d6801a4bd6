#pragma once
// The states of a placement. The frames of the one at hand are added up as they arrive; once it is
// complete it is merged and binned in another thread, beside the frames of the next. At most one is
// being processed: a second waits for it, and keeps the rig alive meanwhile. States are added up in
// the order in which they came, so that the sum is that of one after the other.

#include <array>
#include <optional>
#include <vector>

#include "daemon/alongside.h"
#include "daemon/corrections.h"
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
    const Corrections& corrections;
    const RigProfile& profile;
    const Clock& clock;

    /// Puts the effective times of the bracket right first, as far as its pictures tell that they
    /// are wrong. `exposures`: the bracket's, whose scales are set.
    [[nodiscard]] Result<Processed> operator()(State state,
                                               proc::MergeAccumulator& sums,
                                               std::vector<proc::RawExposure> exposures) const;
    /// For the frames of any state.
    [[nodiscard]] proc::MergeAccumulator accumulator() const;
};

/// Notes how a frame of a bracket was taken: a capture is one exposure of the bracket.
void note(const Frame& frame, Band band, std::vector<proc::RawExposure>& bracket);

class Gathering {
public:
    /// `rig` and `attendance` are borrowed.
    Gathering(driver::Rig& rig, const Attendance& attendance, const Processing& processing);
    Gathering(const Gathering&) = delete;
    Gathering& operator=(const Gathering&) = delete;

    /// A state, whose frames come next. Called twice, what came of it the first time is void.
    void begin(State state);
    [[nodiscard]] Result<void> add(const Frame& frame);
    /// The state is complete; an error is that of the one before.
    [[nodiscard]] Result<void> end();
    /// All that was added, the last state waited for.
    [[nodiscard]] Result<Captured> finish();

private:
    /// A state and its frames so far. Each keeps its memory for the next but one.
    struct Bracket {
        State state;
        proc::MergeAccumulator sums;
        std::vector<proc::RawExposure> exposures;  ///< in the order in which they were taken
    };
    [[nodiscard]] Bracket& atHand() { return brackets_[states_ % brackets_.size()]; }
    Result<void> settle();

    driver::Rig& rig_;
    const Attendance& attendance_;
    const Processing processing_;
    std::array<Bracket, 2> brackets_;
    std::size_t states_ = 0;  ///< complete ones
    Seconds adding_{0};       ///< frames, of the state at hand
    Captured captured_;
    double chiSquare_ = 0, freedom_ = 0;
    std::optional<Alongside<Processed>> running_;
};

}  // namespace gonio::daemon
