#pragma once
// A row of the fault matrix: a fault script, and what must become of a measurement that it
// disturbs. The verdict stands in the script, in comments that begin with "#!":
//     #! verdict completed            or interrupted, fault, refused
//     #! says three times             in the error, or in what the comeback was told
//     #! count resends >= 1           =, <= or >=
//     #! event 7                      the rig told it, and the driver read it
//     #! detected 300ms               the longest from a pulled cable to the comeback
//     #! seeds 20                     in each run of the tests
//     #! waive lostChunks             is not counted exactly in this row, for the reason beside it

#include <string>
#include <vector>

#include "proc/core/units.h"
#include "sim/faults/fault_script.h"

namespace gonio::fault_test {

struct WantedCount {
    std::string name, relation;
    int value = 0;
};

struct Row {
    std::string name;
    sim::FaultScript script;
    std::string verdict;
    std::vector<std::string> says;
    std::vector<WantedCount> counts;
    std::vector<int> events;
    std::vector<std::string> waived;
    Nanoseconds detected{0};  ///< 0: not asked
    int seeds = 1;
};

/// All scripts of the folder, by name.
[[nodiscard]] std::vector<std::string> rowNames();
/// Throws where a script is not as above.
[[nodiscard]] Row readRow(const std::string& name);

}  // namespace gonio::fault_test
