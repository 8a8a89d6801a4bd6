#pragma once
// The rig link (PROTOCOL.md 2): a claimed rig that does numbered commands exactly once. Opening
// checks the protocol string and IDENT, reads LIMITS, and claims the rig; destruction releases it,
// which leaves it dark. Every wait has a deadline on the transport's clock: a silent rig is an
// error after three sends, never a hang. While it waits for chunks the link feeds the heartbeat; a
// caller that is busy elsewhere calls keepAlive(). Not for several threads at once. A rig that
// identity.h refuses is a Device error; one that another session owns is Busy.
//
// A rig that is gone, that does not answer three sends, whose reports stay silent, that has
// rebooted, or whose claim has lapsed is lost: every call repeats why, at once, and the transport
// is not touched any more. resume() takes the claim up again over another transport of the same
// rig; events, our counters and the clock go on. The rig's own are read again and never compared
// with what they were before: they count since its boot, which may be another.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "driver/identity.h"
#include "driver/protocol/reports.h"
#include "driver/protocol/transport.h"
#include "driver/watched_transport.h"
#include "proc/core/result.h"

namespace gonio::driver {

struct LinkOptions {
    std::uint64_t sessionId = 0;  ///< random, low half not 0; the same id takes its claim up again
    std::uint16_t heartbeatMs = 2000;  ///< 500..10000
};

/// Reports that came and were of no use, and commands that had to be repeated.
struct LinkCounters {
    std::uint32_t badReports = 0;      ///< wrong CRC; EVENTS pages that were refused, too
    std::uint32_t unknownReports = 0;  ///< ids that are not in the table
    std::uint32_t foreignAcks = 0;     ///< of another session
    std::uint32_t strayAcks = 0;       ///< ours, but not of the command that waits
    std::uint32_t repeats = 0;         ///< commands sent again for want of an ACK
    std::uint32_t lostStatuses = 0;    ///< gaps in the numbers of STATUS
    std::uint32_t missedEvents = 0;    ///< gone before they could be read again
    bool operator==(const LinkCounters&) const = default;
};

class RigLink {
public:
    /// `transport` is borrowed until the link ends or is lost.
    static Result<std::unique_ptr<RigLink>> open(Transport& transport, const LinkOptions& options);
    ~RigLink();
    RigLink(const RigLink&) = delete;
    RigLink& operator=(const RigLink&) = delete;

    [[nodiscard]] const DeviceStrings& strings() const { return identity_.strings; }
    [[nodiscard]] const Ident& ident() const { return identity_.ident; }
    [[nodiscard]] const Limits& limits() const { return identity_.limits; }
    /// Of the transport; it stands still while the rig is lost.
    [[nodiscard]] const Clock& clock() const { return wire_.clock(); }
    /// The claim was taken up again: settings, ACKs and frames are those of before.
    [[nodiscard]] bool resumed() const { return resumed_; }

    /// Why the rig is lost; empty: it is not.
    [[nodiscard]] const std::optional<Error>& lost() const { return wire_.lost(); }
    /// Takes the claim up again, also with another boot id. Another serial number is a Device error
    /// that names both; after any error the link is lost, and `transport` is not touched any more.
    Result<void> resume(Transport& transport);
    /// After resume(): whether the rig had done the command that the loss cut off; empty: none was
    /// on its way. Another boot has done nothing.
    [[nodiscard]] std::optional<bool> cutOffDone() const { return cutOffDone_; }
    /// As if the rig were gone.
    void abandon(const Error& why) { (void)wire_.lose(why, WatchedTransport::Port::Leave); }

    /// A rig that is BUSY for longer will not become free.
    static constexpr Nanoseconds kBusyLimit = std::chrono::seconds(5);
    /// Sends one command and waits for its final ACK; its result where the status is OK. Other
    /// statuses are errors that carry it (Busy for NOT_OWNER and BUSY, else Device). A rig that is
    /// BUSY is asked again for `patience`.
    Result<Arguments> command(Op op,
                              const Arguments& arguments = {},
                              Nanoseconds patience = kBusyLimit);
    /// Takes what has come, and sends a PING when one is due.
    Result<void> keepAlive();
    /// The next bulk transfer, or nothing when `wait` has passed; the heartbeat is fed meanwhile.
    /// Its bytes are borrowed until the next call of readBulk.
    Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait);

    /// The next STATUS (10 Hz and on change), also from reports that had to be opened anew; a
    /// Device error when none comes.
    Result<Status> freshStatus();
    /// The last one that came by the way.
    [[nodiscard]] const std::optional<Status>& status() const { return status_; }
    Result<Stats> stats();
    /// Events since the last call, oldest first, those lost as reports re-read; the rig keeps 64.
    Result<std::vector<Event>> takeEvents();
    [[nodiscard]] const LinkCounters& counters() const { return counters_; }
    /// How often silent reports were opened anew.
    [[nodiscard]] std::uint32_t reopens() const { return wire_.reopens(); }

    /// Gives the rig back: dark, aborted, flushed. No command works afterwards.
    Result<void> release();

private:
    RigLink(Transport& transport, const LinkOptions& options);
    Result<void> identify();
    Result<void> takeUp(const DeviceStrings& there);
    Result<void> claim();
    Result<void> recall(bool otherBoot);
    Result<void> dropInputs();
    Result<void> readEvents();
    Result<EventsPage> readEventsPage();
    [[nodiscard]] bool missesEvents() const;
    void follow(const Status& status);
    Result<SessionState> setSession(bool release);
    Result<std::optional<Ack>> sendOnce(const Command& command);
    Result<std::optional<Ack>> awaitAck(const Command& command, Nanoseconds wait);
    Result<std::optional<Ack>> storedAck(const Command& command);
    [[nodiscard]] bool answers(const Ack& ack, const Command& command);
    Result<std::optional<Ack>> handleInput(const Report& report);
    Result<void> listen(Nanoseconds wait);
    void keep(const Event& event);
    [[nodiscard]] Nanoseconds pingPeriod() const;
    [[nodiscard]] Nanoseconds untilPing() const;

    WatchedTransport wire_;
    LinkOptions options_;
    Identity identity_;
    bool claimed_ = false;
    bool resumed_ = false;
    std::uint16_t lastCommand_ = 0;
    std::optional<Command> unanswered_;  ///< of which no final ACK has come
    std::optional<bool> cutOffDone_;
    Nanoseconds fed_{0};  ///< when the last command was sent
    std::optional<Status> status_;
    std::optional<std::uint16_t> statusSequence_;
    std::vector<Event> events_;      ///< has room for all that are held
    std::uint32_t lastEvent_ = 0;    ///< event_seq up to which all are taken or kept
    std::uint32_t soughtEvent_ = 0;  ///< the newest that STATUS promised when they were last read
    bool eventsUnread_ = false;      ///< a page could not be read since the last STATUS
    LinkCounters counters_;
};

}  // namespace gonio::driver
