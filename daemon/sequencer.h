#pragma once
// Takes the frames of whole measurements: brackets of one state that find their own way
// (bracket_ladder.h), and lists of shots that are known beforehand. The next capture is armed ahead
// where it is known or foreseen, so that exposures overlap transfers. Each capture has a plan step
// of its own, so that no two share their noise, and the same placement always makes the same
// captures. Frames are handed on as they arrive.
//
// A bracket is of one piece: nothing in it is mixed with what was taken before the rig booted
// again or refused to light, and no frame that is not what was asked for is handed on. Then it is
// taken again (whole_brackets.h), by the same plan steps, so that the frames are those of an
// undisturbed run as far as the light is.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/attendance.h"
#include "daemon/bracket_ladder.h"
#include "daemon/profile.h"
#include "daemon/state.h"
#include "daemon/whole_brackets.h"
#include "driver/rig.h"
#include "proc/radiance/dark.h"

namespace gonio::daemon {

/// A capture that is known before the one before it is seen.
struct KnownShot {
    std::optional<State> state{};  ///< empty: dark
    Shot shot;
    int frames = 1;
    bool joins = false;                       ///< the bracket of the shot before it
    std::optional<std::uint64_t> planStep{};  ///< that it is taken by; empty: the next
};

/// What becomes of a bracket's frames.
struct BracketSink {
    driver::FrameSink frame;
    /// Called before its first frame, and again when it is taken again: what came of it is void.
    std::function<Result<void>()> begin = [] { return Result<void>(); };
};

/// What becomes of the frames of a list of shots, each named by its place in the list.
struct ShotSink {
    /// Each frame, as it arrives. An error ends the list.
    std::function<Result<void>(std::size_t shot, Frame&& frame)> frame;
    /// All frames of a shot are there. An error ends the list.
    std::function<Result<void>(std::size_t shot)> done = [](std::size_t) { return Result<void>(); };
    /// A bracket begins with this shot; once more when it is taken again: what came of it is void.
    std::function<Result<void>(std::size_t shot)> begin = [](std::size_t) {
        return Result<void>();
    };
};

class Sequencer {
public:
    /// `rig` must be configured; it, the profile and the counter must outlive the sequencer.
    Sequencer(driver::Rig& rig,
              const RigProfile& profile,
              std::uint64_t& nextPlanStep,
              Attendance attendance = {});
    Sequencer(const Sequencer&) = delete;
    Sequencer& operator=(const Sequencer&) = delete;

    /// LEDs x R, G, B, in this order.
    [[nodiscard]] std::vector<State> states() const;
    /// All frames of one state's bracket. The first capture of `then`, if its bracket comes next
    /// and by the same plan, is armed ahead with the last of this one.
    [[nodiscard]] Result<void> bracket(State state,
                                       const BracketPlan& plan,
                                       const BracketSink& sink,
                                       std::optional<State> then = {});
    /// One shot after the other.
    [[nodiscard]] Result<void> take(std::span<const KnownShot> shots, const ShotSink& sink);
    /// `frames` of one level and exposure.
    [[nodiscard]] Result<std::vector<Frame>> expose(State state,
                                                    double level,
                                                    Microseconds exposure,
                                                    int frames);
    /// Mean dark frames for the whole ladder of exposures; `done` is called after each, and an
    /// error that it returns ends the ladder.
    [[nodiscard]] Result<proc::DarkLibrary> darks(int frames,
                                                  const std::function<Result<void>()>& done);

    /// whole_brackets.h
    [[nodiscard]] bool review(State state, std::span<const Frame> frames) {
        return brackets_.review(state, frames);
    }
    [[nodiscard]] int breaks() const { return brackets_.breaks(); }
    /// What frames are held against; `begin` of a sink may tell it more.
    [[nodiscard]] FrameWatch& watch() { return brackets_.watch(); }
    /// In the order in which they came.
    [[nodiscard]] const std::vector<OddFrame>& oddFrames() const { return brackets_.oddFrames(); }

private:
    [[nodiscard]] Result<void> climb(State state,
                                     const BracketPlan& plan,
                                     const BracketSink& sink,
                                     std::optional<State> then);
    [[nodiscard]] Result<void> shoot(std::span<const KnownShot> shots,
                                     std::span<const driver::CaptureRequest> requests,
                                     const ShotSink& sink,
                                     std::size_t first);
    template <class Take>
    [[nodiscard]] Result<void> whole(State state, Take take);
    [[nodiscard]] driver::CaptureRequest numbered(driver::CaptureRequest request);
    [[nodiscard]] driver::CaptureRequest begin(driver::CaptureRequest first);
    [[nodiscard]] driver::CaptureRequest prepare(State state, const BracketPlan& plan);
    [[nodiscard]] Result<driver::Capture> capture(const driver::CaptureRequest& request,
                                                  const driver::ArmAhead& ahead = {},
                                                  const driver::FrameSink& sink = {});

    driver::Rig& rig_;
    const RigProfile& profile_;
    std::uint64_t& nextPlanStep_;
    Attendance attendance_;
    int leds_;
    WholeBrackets brackets_;
    std::optional<driver::CaptureRequest> prepared_;  ///< the next bracket's first
};

}  // namespace gonio::daemon
