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
    /// When the next report is due that is still held back.
    [[nodiscard]] Nanoseconds nextEvent(Nanoseconds now) const;

    /// Somebody opened the reports anew: what is silent for no certain time speaks again.
    void opened() {
        if (silentUntil_ == Nanoseconds::max()) silentUntil_ = Nanoseconds(0);
        if (stalledUntil_ == Nanoseconds::max()) stalledUntil_ = Nanoseconds(0);
    }
    /// The endpoint stalls.
    [[nodiscard]] bool stalled(Nanoseconds now) const { return now < stalledUntil_; }
    void clearHalt() { stalledUntil_ = Nanoseconds(0); }
    /// The rig has lost its link: what was on its way is lost.
    void clear() {
        held_.clear();
        extra_.clear();
        delays_.clear();
        acksToLose_ = toDrop_ = toSpoil_ = 0;
        clearHalt();
    }

private:
    FaultTally& tally_;
    int acksToLose_ = 0, toDrop_ = 0, toSpoil_ = 0;
    std::deque<Nanoseconds> delays_;
    std::multimap<Nanoseconds, driver::Report> held_;
    std::deque<driver::Report> extra_;
    Nanoseconds silentUntil_{0}, stalledUntil_{0};
};

}  // namespace gonio::sim
