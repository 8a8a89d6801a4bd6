#pragma once
// A measurement as an engine makes it, small: three brackets of three captures of two frames, the
// next one armed ahead. A rig that is lost is looked for again; after another boot the bracket is
// redone.

#include <map>
#include <string>
#include <vector>

#include "driver/rig.h"
#include "tests/faults/rig_door.h"
#include "tests/faults/row.h"

namespace gonio::fault_test {

/// Pictures by plan step.
using Pictures = std::map<std::uint64_t, std::vector<Image<std::uint16_t>>>;

struct Outcome {
    std::string verdict;
    std::string said;  ///< the error, and what the comeback was told
    Pictures pictures;
    std::map<std::string, int> counts;
    std::vector<int> events;            ///< their codes
    std::vector<std::string> troubles;  ///< what no row may show
    std::vector<std::string> malformed;
    Nanoseconds detected{0};     ///< the longest; likewise those that follow
    Nanoseconds reclaimed{0};    ///< from the plug to the claim
    Nanoseconds noticed{0};      ///< from silent reports to their opening
    Nanoseconds longestCall{0};  ///< of the transport, beyond what it was to wait
    int slack = 1;               ///< how many times a limit may last
};

[[nodiscard]] Outcome measure(RigDoor& door, const RigSetup& setup, const Row& row);
/// Of a rig that nothing disturbs.
[[nodiscard]] const Pictures& undisturbed(const RigSetup& setup);

// Its parts, for measurements of another shape.

/// The script's time begins; what the rig and other scripts did before is not counted.
void beginScript(RigDoor& door, const sim::FaultScript& script, Outcome& outcome);
/// How often a lost rig is looked for, and how long each time.
struct SearchLimits {
    int comebacks = 0;
    Nanoseconds each{0};
};
/// Looks for a lost rig until it is back. Says in the outcome what it was told. Both are borrowed.
[[nodiscard]] driver::Comeback comebackThrough(RigDoor& door,
                                               Outcome& outcome,
                                               const SearchLimits& limits);
/// Times that it was lost since they were last noted.
void noteInterruptions(driver::Rig& rig, Outcome& outcome);
/// What the driver saw of the rig since it was opened and what the script did since it began, kind
/// by kind, and whether an event was missed.
void readBack(driver::Rig& rig, RigDoor& door, Outcome& outcome);

/// What is not as the row wants it; empty: it has passed.
[[nodiscard]] std::vector<std::string> complaints(const Row& row,
                                                  const Outcome& outcome,
                                                  const Pictures& undisturbed);

}  // namespace gonio::fault_test
