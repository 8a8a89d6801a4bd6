#pragma once
// What is to go wrong with a simulated rig, and when: a text of rules, one on a line, as
// docs/fault-scripts.md has them ("at 1.2s unplug for 300ms"). What is random in a script is drawn
// from its seed by rule and occurrence, so that it is the same on every door.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driver/protocol/constants.h"
#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio::sim {

enum class FaultKind : std::uint8_t {
    // The cable.
    Unplug,
    UnplugQuietly,  ///< seen first by a submit that is refused
    LosePower,      ///< unplugged, and another boot afterwards
    Plug,
    PlugRebooted,
    PlugAs,  ///< another rig, of this serial number
    // The bus.
    StallBulk,
    BreakTransfer,  ///< a transfer that ends in an error of the bus
    Overflow,
    StallReports,    ///< the endpoint halts, as a device that is confused does
    SilenceReports,  ///< NAK without end
    Hang,            ///< enumerated, and every request is answered with NAK
    HangUntilReset,
    EndHang,
    LimitTransfers,  ///< the system has no memory for more
    EndLimit,
    // Chunks.
    ShortenChunk,
    LengthenChunk,
    EmptyPacket,
    FlipPayload,
    FlipHeader,
    BurstPayload,
    LoseChunk,
    DuplicateChunk,
    SwapChunks,
    StaleFrame,
    UnknownChunk,
    // Reports and commands.
    LoseCommand,
    LoseAck,
    DelayAck,
    DropReport,
    PileUpReports,  ///< more come than the host's queue holds
    SpoilReport,    ///< its CRC is wrong
    UnknownReport,
    UnknownEvent,
    // The rig.
    OpenInterlock,
    CloseInterlock,
    Overheat,
    CoolDown,
    JumpClock,
    WrapClock,
    NewerMinor,
    NewerMajor,
    Malform,
    // Frames that are well formed and wrong.
    PreviousFrame,
    BlackFrame,
    UnlitLed,
    LateSettings,
    HiddenLateSettings,
    OldExposure,
    Reflex,
    LedDrift,
    Count
};
inline constexpr std::size_t kFaultKinds = static_cast<std::size_t>(FaultKind::Count);

/// As a script says it: "lose chunk".
[[nodiscard]] std::string_view faultName(FaultKind kind);

/// Both ends included; equal: nothing is random.
struct FaultRange {
    double low = 0, high = 0;
};

/// A time is in seconds, a count a whole number.
struct Fault {
    FaultKind kind = FaultKind::Count;
    FaultRange count{1, 1};  ///< chunks, bits, reports, transfers
    FaultRange time{};       ///< a delay, a jump of the clock
    std::optional<FaultRange> lasting{};
    std::string name{};  ///< a serial number, or what is malformed
};

struct FaultMoment {
    enum class Kind {
        Time,
        Period,
        Exposure,   ///< the so-manieth exposure begins
        FrameSent,  ///< the TRAILER of the so-manieth frame has been sent
        OnCommand,  ///< before the rig does it
        AfterCommand,
        Chunk,     ///< the so-manieth chunk that is sent
        PerChunk,  ///< and the next two: with a chance each time
        PerExposure,
        PerCommand,
    };
    Kind kind = Kind::Time;
    FaultRange value{};  ///< seconds, or which one: counted from 1
    double chance = 0;
    std::optional<FaultRange> ofFrame{};  ///< `value` counts from 0 within this frame then
    std::optional<driver::Op> op{};       ///< commands of this op only
};

struct FaultRule {
    int line = 0;
    FaultMoment when;
    std::vector<Fault> faults;  ///< one of them, each as likely as the others
};

struct FaultScript {
    static constexpr std::size_t kMostBytes = std::size_t{1} << 20;

    std::uint64_t seed = 1;
    std::vector<FaultRule> rules;

    /// A File error that names the line; never more than kMostBytes are read.
    [[nodiscard]] static Result<FaultScript> parse(std::string_view text);
};

}  // namespace gonio::sim
