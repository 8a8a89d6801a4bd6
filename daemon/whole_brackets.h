#pragma once
// A bracket is of one piece, or it is taken again from its first shot:
//   - when the rig has booted meanwhile: at most three times, or the rig does not stay up;
//   - when the rig would not light (interlock, temperature), once it may light again;
//   - when a frame is not what was asked for (frame_watch.h). One that is odd once more is refused
//     with its evidence; but a bracket that has no light twice is what lies there.
// Any other error ends it. After a boot, and after light that was off for a while, the next lit
// bracket's LED is lit for the profile's warm-up before. A cable bump of the same boot is none of
// this: the driver asks for the frames that are missing again (PROTOCOL.md 4).

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "daemon/attendance.h"
#include "daemon/frame_watch.h"
#include "daemon/profile.h"
#include "daemon/state.h"
#include "driver/rig.h"

namespace gonio::daemon {

class WholeBrackets {
public:
    /// All is borrowed. `nextPlanStep`: frames that warm up and are thrown away need none of their
    /// own.
    WholeBrackets(driver::Rig& rig,
                  const RigProfile& profile,
                  const std::uint64_t& nextPlanStep,
                  const Attendance& attendance);

    /// `attempt` takes all shots of a bracket, whose first is of `state`, and shows each frame to
    /// look() before it is used.
    [[nodiscard]] Result<void> take(std::optional<State> state,
                                    const std::function<Result<void>()>& attempt);
    /// An error, which has to end the attempt, for one that is not what was asked for.
    [[nodiscard]] Result<void> look(std::optional<State> state, const Frame& frame);
    /// The frames of a bracket that was taken before the watch knew what it knows now. False: one
    /// is not what was asked for, which is told; the bracket wants taking again.
    [[nodiscard]] bool review(State state, std::span<const Frame> frames);
    /// The driver has taken frames of it again, by what the rig said of them.
    void rejected(const std::string& evidence) const {
        tell(Cause::Rejected, "not as asked for, and taken again: " + evidence);
    }

    /// How often so far the rig has booted again or refused to light: what was taken at another
    /// count is not of one piece with what is taken now.
    [[nodiscard]] int breaks() const { return breaks_; }

    [[nodiscard]] FrameWatch& watch() { return watch_; }
    [[nodiscard]] const std::vector<OddFrame>& oddFrames() const { return odd_; }

private:
    using Cause = Setback::Cause;
    void open(std::optional<State> state);
    [[nodiscard]] Result<void> warmUp(std::optional<State> state);
    [[nodiscard]] Result<void> mayTakeAgain(const Error& why);
    /// Why the rig will light again, though not now; empty: that is not known.
    [[nodiscard]] std::optional<Error> passes(const Error& why);
    [[nodiscard]] std::optional<Error> takeReboot();
    [[nodiscard]] int& attemptsLike(const OddFrame& odd) {
        return odd.kind == Cause::Unlit ? unlitAttempts_ : oddAttempts_;
    }
    void noteBreak();
    void tell(Cause cause, const std::string& message) const;

    driver::Rig& rig_;
    const RigProfile& profile_;
    const std::uint64_t& nextPlanStep_;
    const Attendance& attendance_;
    FrameWatch watch_;
    std::vector<OddFrame> odd_;
    std::vector<OddFrame> reviewed_;  ///< of brackets that have not been taken again yet
    int breaks_ = 0;
    bool cold_ = false;  ///< no lit bracket has been taken since the last of them

    // Of the bracket at hand.
    std::optional<State> state_;
    int boots_ = 0;
    int unlitAttempts_ = 0,
        oddAttempts_ = 0;  ///< that ended without light, and by what else is odd
    bool isOdd_ = false;   ///< the newest of odd_ has ended the attempt
};

}  // namespace gonio::daemon
