#pragma once
// A row of the fault matrix: a fault script, and what must become of a measurement that it
// disturbs. The verdict stands in the script, in comments that begin with "#!":
//     #! verdict completed            or interrupted, fault, refused
//     #! says three times             in the error, in the log, or in what the comeback was told
//     #! when led-count-none says led_count    if that is malformed; all that may be have a line
//     #! count repeats >= 1           =, <= or >=; the names are those of kCounters
//     #! event 7                      the rig told it, and the driver read it
//     #! detected 300ms               the longest from a pulled cable to the comeback
//     #! reclaimed 2s                 the longest from the plug to the claim
//     #! noticed 600ms                the longest from silent reports to their opening
//     #! waive lostChunks -1          exactly so many more than were caused, for the reason beside
//     #! only umockdev                the door on which it is played; else on both
// In real time the three limits are ten times as long: the machine has other work.
// A line that is not so is refused.

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/units.h"
#include "sim/faults/fault_script.h"

namespace gonio::fault_test {

/// All that is counted in a measurement, and can be asked for.
inline constexpr std::array<std::string_view, 37> kCounters{"aborted",        "badFrames",
                                                            "badHeaders",     "badLengths",
                                                            "badPayloads",    "badReports",
                                                            "bracketsRedone", "chunksResent",
                                                            "contradictions", "deviceStatus",
                                                            "disordered",     "duplicates",
                                                            "emptyTransfers", "eventGaps",
                                                            "events",         "foreignAcks",
                                                            "framesMade",     "haltsCleared",
                                                            "inFlight",       "interruptions",
                                                            "lostChunks",     "lostStatuses",
                                                            "missedEvents",   "otherBoots",
                                                            "portResets",     "redone",
                                                            "reopens",        "repeats",
                                                            "replays",        "reportsOverflowed",
                                                            "resent",         "ring",
                                                            "stale",          "statusesUnexplained",
                                                            "steps",          "unknownReports",
                                                            "unknownTypes"};
[[nodiscard]] bool isCounter(std::string_view name);

struct WantedCount {
    std::string name, relation;
    int value = 0;
};

struct Row {
    std::string name;
    sim::FaultScript script;
    std::string verdict;
    std::vector<std::string> says;
    std::map<std::string, std::string> saysWhen;  ///< by what is malformed
    std::vector<WantedCount> counts;
    std::vector<int> events;
    std::map<std::string, int> waived;  ///< seen less caused
    Nanoseconds detected{0};            ///< 0: not asked; likewise the next two
    Nanoseconds reclaimed{0};
    Nanoseconds noticed{0};
    std::string only;  ///< the name of a door
};

/// All scripts of the folder that are played on this door ("inproc", "umockdev"), by name.
[[nodiscard]] std::vector<std::string> rowNames(const std::string& door);
/// Throws where a script is not as above, and says what is wrong.
[[nodiscard]] Row readRow(const std::string& name);
[[nodiscard]] Row parseRow(const std::string& name, const std::string& text);
/// The row, or one for each of the malformations that it chooses from.
[[nodiscard]] std::vector<Row> variantsOf(const Row& row);

}  // namespace gonio::fault_test
