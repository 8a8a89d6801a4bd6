#pragma once
// What the rig says by itself: the input reports on their way to the host, and the last 64 events,
// which can be read again (PROTOCOL.md 2). The host's queue holds 63 reports; what comes with
// a STATUS that does not fit is lost.

#include <cstdint>
#include <deque>
#include <optional>

#include "driver/protocol/reports.h"

namespace gonio::sim {

class Notices {
public:
    /// What happened; its arguments are the event's own.
    struct Happening {
        std::uint16_t code = 0;
        std::uint32_t arg0 = 0, arg1 = 0;
    };
    void raise(const Happening& happening, std::uint64_t timeUs);
    void answer(const driver::Ack& ack) { inputs_.push_back(encode(ack)); }
    void tell(const driver::Status& status);
    [[nodiscard]] std::optional<driver::Report> take();

    /// Reports that did not fit into the host's queue, and those of them that were a STATUS.
    struct Overflow {
        int reports = 0, statuses = 0;
    };
    [[nodiscard]] const Overflow& overflow() const { return overflow_; }

    [[nodiscard]] std::uint32_t newestEvent() const { return nextEvent_ - 1; }
    void readEventsFrom(std::uint32_t sequence) { from_ = sequence; }
    [[nodiscard]] driver::EventsPage page() const;

private:
    std::deque<driver::Report> inputs_;
    Overflow overflow_;
    std::deque<driver::Event> events_;
    std::uint32_t nextEvent_ = 1;
    std::uint32_t from_ = 0;
};

}  // namespace gonio::sim
