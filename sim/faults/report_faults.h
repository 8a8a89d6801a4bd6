#pragma once
// What goes wrong with input reports on their way to the host.

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "driver/protocol/transport.h"
#include "sim/faults/chunk_faults.h"

namespace gonio::sim {

class ReportFaults {
public:
    explicit ReportFaults(FaultTally& tally) : tally_(tally) {}

    /// False: it is no fault of reports.
    bool put(const DueFault& fault, Nanoseconds now);
    /// The next report that comes through of those that the rig has.
    [[nodiscard]] std::optional<driver::Report> next(Device& device);
    /// When a report is due that was held back.
    [[nodiscard]] Nanoseconds nextEvent() const;

    /// Nothing comes through until then, or until somebody opens the reports anew.
    void silence(Nanoseconds until) { silentUntil_ = until; }
    void opened() { silentUntil_ = Nanoseconds(0); }

private:
    FaultTally& tally_;
    int acksToLose_ = 0, toDrop_ = 0, toSpoil_ = 0;
    std::deque<Nanoseconds> delays_;
    std::multimap<Nanoseconds, driver::Report> held_;
    std::deque<driver::Report> extra_;
    Nanoseconds silentUntil_{0};
};

}  // namespace gonio::sim
