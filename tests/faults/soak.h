#pragma once
// Ten frames a second with a fault of any kind again and again, in bulk data, reports, commands and
// at the cable: each frame is held against an undisturbed rig's, and what the driver counted
// against what was done to it, kind by kind. The same on every door.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tests/faults/rig_door.h"

namespace gonio::fault_test {

struct SoakPlan {
    static constexpr int kFramesPerCapture = 5;
    static constexpr Nanoseconds kCapturePeriod = std::chrono::milliseconds(500);

    int captures = 0;
    std::string every = "9s..11s";  ///< from a fault to the next, as fault scripts have it
    std::uint64_t seed = 1;
    /// The rig's clock is the computer's. On a busy machine a rig that answers late is lost once
    /// more, and reports that come late are opened anew: then those two are counted at least, and
    /// of reports some pass unseen.
    bool realTime = false;
};

struct Soaked {
    int captures = 0;                    ///< as planned, and until the last fault is over
    int frames = 0;                      ///< those that are as they should be
    std::map<std::string, int> kinds{};  ///< of fault, and how often each came
    int faults = 0;                      ///< what the script did
    int pulls = 0;                       ///< those of them that cost the link: cable, power, port
    int interruptions = 0;               ///< times that the driver lost the rig and had it back
    Nanoseconds lasted{0};               ///< on the rig's clock
    Nanoseconds noticed{0};              ///< the longest from a pulled cable to its loss
    std::vector<std::string> troubles;   ///< what is not as it should be; empty: it has passed
};

/// Nobody has the door open; it is closed again at the end.
[[nodiscard]] Soaked soak(RigDoor& door, const RigSetup& setup, const SoakPlan& plan);

/// One line for people.
[[nodiscard]] std::string summaryOf(const Soaked& soaked);

}  // namespace gonio::fault_test
