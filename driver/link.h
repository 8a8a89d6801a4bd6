#pragma once
// The command link to one rig: identify, claim, numbered commands with ACK,
// heartbeat, input reports. Every command is done exactly once: it is repeated
// with the same number until its ACK is known, by the input report or by
// reading LAST_ACK. Every wait has a deadline on the transport's clock.

#include <cstdint>
#include <deque>
#include <optional>

#include "driver/protocol/reports.h"
#include "driver/protocol/transport.h"

namespace gonio::driver {

class RigLink {
public:
    /// Refuses another protocol major, naming both versions; claims the rig. Busy
    /// when it is owned. `transport` must outlive the link. `sessionId`: random,
    /// its low half not 0.
    [[nodiscard]] static Result<RigLink> open(Transport& transport, std::uint64_t sessionId);

    [[nodiscard]] const Ident& ident() const { return ident_; }
    [[nodiscard]] const Limits& limits() const { return limits_; }
    [[nodiscard]] Transport& transport() { return *transport_; }

    /// Sends one command and waits for its final ACK. An ACK other than OK is a
    /// Device error that carries the status.
    [[nodiscard]] Result<Arguments> command(Op op, const Arguments& arguments = {});
    /// Reads what has come and sends a PING when the heartbeat needs it. Call it
    /// while waiting.
    Result<void> keepAlive();
    /// The newest STATUS report seen.
    [[nodiscard]] const std::optional<Status>& status() const { return status_; }
    /// Events seen since they were last taken.
    [[nodiscard]] std::deque<Event> takeEvents();

    /// Gives the rig back: it goes dark.
    Result<void> release();

private:
    RigLink(Transport& transport, std::uint64_t sessionId)
        : transport_(&transport), sessionId_(sessionId) {}

    Result<void> claim();
    [[nodiscard]] Result<std::optional<Ack>> awaitAck(const Command& command, Nanoseconds wait);
    [[nodiscard]] Result<std::optional<Ack>> readLastAck(const Command& command);
    [[nodiscard]] std::optional<Ack> sort(const Report& report, const Command* waitingFor);
    [[nodiscard]] bool answers(const Ack& ack, const Command& command) const;

    Transport* transport_;
    std::uint64_t sessionId_;
    std::uint16_t heartbeatMs_ = 2000;
    std::uint16_t sequence_ = 0;
    Nanoseconds lastSent_{0};
    Ident ident_;
    Limits limits_;
    std::optional<Status> status_;
    std::deque<Event> events_;
};

}  // namespace gonio::driver
