#pragma once
// What goes wrong with input reports on their way to the host. Silent: the endpoint answers with
// NAK, and what the rig says is lost. Stalled: it answers with STALL until its halt is cleared, and
// what the rig says waits; a stall that lasts is there again after each clearing until it is over.

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
    /// When the next report is due that is still held back.
    [[nodiscard]] Nanoseconds nextEvent(Nanoseconds now) const;

    /// Somebody opened the reports anew: what is silent for no certain time speaks again.
    void opened(Nanoseconds now);
    /// A rig that is plugged in begins with sound endpoints.
    void plugged();
    /// The rig has lost its link: what was on its way, or waited for a report, is lost.
    void clear();
    [[nodiscard]] bool stalled() const { return stalled_; }
    /// Somebody cleared the halt of the endpoint.
    void haltCleared(Nanoseconds now);
    [[nodiscard]] int haltsCleared() const { return haltsCleared_; }
    /// The longest time from a silence or a lasting stall to the opening that it led to.
    [[nodiscard]] Nanoseconds noticed() const { return noticed_; }
    /// STATUS reports that did not come through.
    [[nodiscard]] int statusesLost() const { return statusesLost_; }

private:
    void lose(const driver::Report& report);

    FaultTally& tally_;
    int acksToLose_ = 0, toDrop_ = 0, toSpoil_ = 0;
    std::deque<Nanoseconds> delays_;
    std::multimap<Nanoseconds, driver::Report> held_;
    std::deque<driver::Report> extra_;
    Nanoseconds silentUntil_{0}, stalledUntil_{0};
    bool stalled_ = false;
    int haltsCleared_ = 0, statusesLost_ = 0;
    std::optional<Nanoseconds> unheardSince_;  ///< until they are opened anew
    Nanoseconds noticed_{0};
};

}  // namespace gonio::sim
