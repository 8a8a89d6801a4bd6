#pragma once
// How fast a rig's clock runs against this computer's. A reading is a command SYNC_TIME: the rig's
// time is held against the middle of its round trip, and is wrong by up to half of that where one
// way takes longer than the other. What all readings share leaves the drift alone. Where the
// computer gets busier between two looks they share it no more: the offset shifts, and the scatter
// inside either look does not show it. So two looks that differ by more than crystals do are not
// believed: there are more, and the scatter of the looks about a straight line counts; where there
// is no time for more, what the round trips leave open.

#include <span>

#include "driver/link.h"

namespace gonio::daemon {

/// Relative, with room: two usual crystals differ by 100 ppm at most.
inline constexpr double kMostCrystalsDiffer = 200e-6;
/// s, a round trip: a command is repeated after 0.1 s. What is slower tells no drift.
inline constexpr double kSlowRoundTrip = 0.02;

/// The rig's clock beside the host's: means of the readings whose answer came quickly, times in s.
struct ClockLook {
    double host = 0;    ///< on the link's clock
    double offset = 0;  ///< the rig's clock less the host's
    /// Of the offset, k = 1: by the scatter of the readings; of less than four, `furthest`.
    double uncertainty = 0;
    double furthest = 0;   ///< the offset is off by no more: half of their mean round trip
    double roundTrip = 0;  ///< the shortest
    double usual = 0;      ///< the mean round trip of all readings, slow ones too
};

/// 32 readings; no more after 0.3 s, but four at least, however slow the link.
[[nodiscard]] Result<ClockLook> lookAtClock(driver::RigLink& link);

struct ClockDrift {
    double relative = 0;     ///< how much faster the rig's clock runs than the host's
    double uncertainty = 0;  ///< of that, 95 %
    double passed = 0;       ///< s, from the first look to the last
    double roundTrip = 0;    ///< s, of the slowest look

    /// By more than its uncertainty beyond what crystals differ.
    [[nodiscard]] bool beyondCrystals() const;
};

/// The slope of the straight line through `looks`, each weighing the same. Its uncertainty comes
/// from their residuals, by Student's t for looks - 2 degrees of freedom (of more than six looks:
/// as of six, which is too wide); it is never less than twice what the scatter inside the looks
/// gives, nor than what a shift makes of it that is as large as their round trips allow, between
/// any two. Two looks have no residuals: only the scatter. Precondition: two or more, not at the
/// same time.
[[nodiscard]] ClockDrift driftOf(std::span<const ClockLook> looks);

/// A second look, one second after the first or later. Where the two are beyond crystals and the
/// link is not slow, four more, one a second, of which none begins later than 6 s after the first.
/// Where it is slow, or there is time for none of the four, the uncertainty is what the round trips
/// of the two leave open, and surely holds the drift. The heartbeat is fed meanwhile.
[[nodiscard]] Result<ClockDrift> driftSince(const ClockLook& first, driver::RigLink& link);

}  // namespace gonio::daemon
