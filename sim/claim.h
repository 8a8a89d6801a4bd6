#pragma once
// Who has the rig (PROTOCOL.md 2, "Sessions"), and the answers he got: a command that comes again
// is answered again and done once ("Exactly once"). The last 8 answers are kept, also over a lapse.

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "driver/protocol/reports.h"
#include "proc/core/units.h"

namespace gonio::sim {

class Claim {
public:
    [[nodiscard]] bool alive() const { return owner_ == driver::Owner::Alive; }
    [[nodiscard]] driver::Owner owner() const { return owner_; }
    [[nodiscard]] std::uint64_t id() const { return id_; }
    [[nodiscard]] std::uint32_t lowId() const { return static_cast<std::uint32_t>(id_); }
    [[nodiscard]] std::uint16_t lastCommand() const { return lastCommand_; }
    [[nodiscard]] driver::SessionState state(std::uint16_t statusOfLastSet) const;

    /// Who claims has it from now on; everything that was stored stays.
    void renew(const driver::SessionSet& set, Nanoseconds now);
    /// Control is lost; what was stored stays.
    void lapse() { owner_ = driver::Owner::Lapsed; }

    // The heartbeat.
    void feed(Nanoseconds now) { fed_ = now; }
    [[nodiscard]] Nanoseconds lapsesAt() const { return fed_ + heartbeat_; }
    [[nodiscard]] Nanoseconds silence(Nanoseconds now) const { return now - fed_; }

    /// The answer to a command that is not to be done: a stranger's, one that was done before, or
    /// one out of order.
    struct Answer {
        driver::Ack ack;
        bool replayed = false;
    };
    [[nodiscard]] bool owns(const driver::Command& command) const;
    [[nodiscard]] std::optional<Answer> answerOf(const driver::Command& command) const;
    void keep(const driver::Command& command, const driver::Ack& ack);
    /// The newest answer; empty fields when there is none.
    [[nodiscard]] driver::Ack newest() const;

private:
    std::uint64_t id_ = 0;
    Nanoseconds heartbeat_{0};
    std::uint8_t hostMinor_ = 0;
    driver::Owner owner_ = driver::Owner::None;
    Nanoseconds fed_{0};
    std::uint16_t lastCommand_ = 0;
    std::deque<std::pair<driver::Command, driver::Ack>> stored_;
};

}  // namespace gonio::sim
