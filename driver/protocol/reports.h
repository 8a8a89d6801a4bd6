#pragma once
// The HID reports of GRP/1 as plain structs, and their bytes. encode() fills a 64-byte report with
// its id and CRC; decode...() checks id and CRC and returns what it saw, or a Device error that
// names the report. Ranges of fields are the receiver's business: a codec loses nothing.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "driver/protocol/constants.h"
#include "driver/protocol/transport.h"
#include "proc/core/result.h"

namespace gonio::driver {

inline constexpr std::size_t kArgumentBytes = 44;
using Arguments = std::array<std::uint8_t, kArgumentBytes>;

struct Ident {
    std::uint8_t major = 1, minor = 0, hardwareRevision = 0;
    std::uint32_t firmware = 0;      ///< major << 16, minor << 8, patch
    std::uint32_t capabilities = 0;  ///< bit0 module port, bit1 binning, bit2 resend
    std::uint32_t bootId = 0;
    std::uint16_t sensorWidth = 0, sensorHeight = 0;
    std::uint8_t bitDepth = 12, ledCount = 0;
    std::array<std::int16_t, kMaxLeds> ledAngle{};  ///< 0.01 degree from the normal
    std::array<std::uint16_t, 3> wavelengthNm{};
    std::uint32_t maxChunkPayload = 0;
    std::uint16_t frameRam = 0;
    std::uint32_t exposureMinUs = 0, exposureMaxUs = 0;
    std::uint16_t exposureStep = 0;  ///< 0.01 us
    std::uint8_t controlLatency = 1, ledSettleMs = 0;
    bool operator==(const Ident&) const = default;
};

struct SessionSet {
    std::uint64_t sessionId = 0;
    std::uint16_t heartbeatMs = 2000;
    std::uint8_t hostMinor = kProtocolMinor;
    bool release = false;
    bool operator==(const SessionSet&) const = default;
};

struct SessionState {
    std::uint64_t sessionId = 0;  ///< 0 = none
    std::uint16_t heartbeatMs = 0;
    std::uint8_t hostMinor = 0;
    std::uint16_t statusOfLastSet = 0;
    std::uint16_t lastCommand = 0;
    Owner owner = Owner::None;
    bool operator==(const SessionState&) const = default;
};

struct Event {
    std::uint32_t sequence = 0;
    std::uint64_t timeUs = 0;
    std::uint16_t code = 0;
    std::uint32_t arg0 = 0, arg1 = 0;
    bool operator==(const Event&) const = default;
};

struct EventsPage {
    std::uint32_t oldest = 0, newest = 0;
    std::vector<Event> events;  ///< at most 2
    bool operator==(const EventsPage&) const = default;
};

struct Stats {
    std::uint32_t uptimeS = 0, fifoOverruns = 0, crcRejects = 0, resends = 0, framesMade = 0,
                  framesGone = 0, commandsDone = 0, replays = 0, lapses = 0;
    bool operator==(const Stats&) const = default;
};

struct Limits {
    std::uint8_t formats = 0;   ///< bit n-1 = pixel_format n
    std::uint8_t binnings = 0;  ///< bit0 = 1, bit1 = 2, bit2 = 4
    std::uint8_t roiStep = 1;
    std::uint16_t maxFrames = 0;
    std::uint32_t framePeriodUs = 0;
    std::uint16_t gainMax = 0;  ///< 0.01 dB
    std::uint16_t blackLevel = 0, fullScale = 0;
    std::array<std::uint16_t, 3> ledFull{};   ///< 0.1 mA at level 65535
    std::array<std::uint16_t, 3> ledWhite{};  ///< levels of equal signals on white
    std::uint16_t ledTolerance = 0;           ///< 0.01 %
    std::array<std::int16_t, 2> ledTemperature{}, sensorTemperature{};  ///< 0.01 degC
    bool operator==(const Limits&) const = default;
};

/// Degrees Celsius of a temperature field; empty: there is no such sensor.
[[nodiscard]] inline std::optional<double> celsius(std::int16_t hundredths) {
    return hundredths == kNoTemperature ? std::nullopt : std::optional(hundredths * 0.01);
}

struct Status {
    std::uint16_t sequence = 0;
    std::uint32_t bootId = 0;
    std::uint64_t timeUs = 0;
    RigState state = RigState::Boot;
    std::uint8_t interlock = 0;
    std::uint32_t ledOn = 0;                    ///< bit 3 * led + channel
    std::array<std::uint16_t, 3> ledCurrent{};  ///< 0.1 mA
    std::array<std::int16_t, 4> temperature{};  ///< 0.01 degC
    std::uint16_t lastCommand = 0;
    std::uint64_t captureId = 0;
    std::uint32_t framesMade = 0;
    std::uint16_t fifoFrames = 0;
    std::uint32_t newestEvent = 0;
    std::uint16_t fault = 0;
    Owner owner = Owner::None;
    bool operator==(const Status&) const = default;
};

struct Command {
    std::uint32_t sessionLow = 0;
    std::uint16_t sequence = 0;
    Op op = Op::Ping;
    Arguments arguments{};
    bool operator==(const Command&) const = default;
};

struct Ack {
    std::uint16_t sequence = 0;
    Op op = Op::Ping;
    std::uint16_t status = 0;
    std::uint16_t retryMs = 0;
    Arguments result{};
    std::uint32_t sessionLow = 0;
    bool operator==(const Ack&) const = default;
};

// Arguments and results of the commands.
struct SetLed {
    std::uint8_t led = 0;
    std::array<std::uint16_t, 3> levels{};
    bool operator==(const SetLed&) const = default;
};
struct SetExposure {
    std::uint32_t exposureUs = 0;
    std::uint16_t gain = 0;  ///< 0.01 dB
    bool operator==(const SetExposure&) const = default;
};
struct Granted {
    std::uint64_t exposureNs = 0;
    std::uint16_t gain = 0;
    std::uint32_t effectiveFrame = 0;
    bool operator==(const Granted&) const = default;
};
struct SetFormat {
    PixelFormat format = PixelFormat::Mono12Packed;
    std::uint16_t x = 0, y = 0, width = 0, height = 0;
    std::uint8_t binning = 1;
    bool operator==(const SetFormat&) const = default;
};
struct Arm {
    std::uint64_t captureId = 0;
    std::uint16_t frames = 1;
    std::uint8_t trigger = 0;  ///< 0 free run, 1 software
    bool operator==(const Arm&) const = default;
};
struct Resend {
    std::uint64_t captureId = 0;
    std::uint16_t frame = 0, firstChunk = 0, lastChunk = 0xFFFF;
    bool operator==(const Resend&) const = default;
};

[[nodiscard]] Arguments encode(const SetLed& v);
[[nodiscard]] Arguments encode(const SetExposure& v);
[[nodiscard]] Arguments encode(const Granted& v);
[[nodiscard]] Arguments encode(const SetFormat& v);
[[nodiscard]] Arguments encode(const Arm& v);
[[nodiscard]] Arguments encode(const Resend& v);
/// One number at offset 0: the capture_id, time or frame number of the other commands.
[[nodiscard]] Arguments encodeU32(std::uint32_t v);
[[nodiscard]] Arguments encodeU64(std::uint64_t v);

[[nodiscard]] SetLed decodeSetLed(const Arguments& bytes);
[[nodiscard]] SetExposure decodeSetExposure(const Arguments& bytes);
[[nodiscard]] Granted decodeGranted(const Arguments& bytes);
[[nodiscard]] SetFormat decodeSetFormat(const Arguments& bytes);
[[nodiscard]] Arm decodeArm(const Arguments& bytes);
[[nodiscard]] Resend decodeResend(const Arguments& bytes);
[[nodiscard]] std::uint32_t decodeU32(const Arguments& bytes);
[[nodiscard]] std::uint64_t decodeU64(const Arguments& bytes);

[[nodiscard]] Report encode(const Ident& v);
[[nodiscard]] Report encode(const SessionSet& v);
[[nodiscard]] Report encode(const SessionState& v);
[[nodiscard]] Report encode(const EventsPage& v);
[[nodiscard]] Report encodeEventsFrom(std::uint32_t fromSequence);
[[nodiscard]] Report encode(const Stats& v);
[[nodiscard]] Report encode(const Limits& v);
[[nodiscard]] Report encode(const Status& v);
[[nodiscard]] Report encode(const Event& v);
[[nodiscard]] Report encode(const Command& v);
/// `id`: Ack as an input report, LastAck as the feature of the same layout.
[[nodiscard]] Report encode(const Ack& v, ReportId id = ReportId::Ack);

[[nodiscard]] Result<Ident> decodeIdent(const Report& report);
[[nodiscard]] Result<SessionSet> decodeSessionSet(const Report& report);
[[nodiscard]] Result<SessionState> decodeSessionState(const Report& report);
[[nodiscard]] Result<EventsPage> decodeEventsPage(const Report& report);
[[nodiscard]] Result<std::uint32_t> decodeEventsFrom(const Report& report);
[[nodiscard]] Result<Stats> decodeStats(const Report& report);
[[nodiscard]] Result<Limits> decodeLimits(const Report& report);
[[nodiscard]] Result<Status> decodeStatus(const Report& report);
[[nodiscard]] Result<Event> decodeEvent(const Report& report);
[[nodiscard]] Result<Command> decodeCommand(const Report& report);
[[nodiscard]] Result<Ack> decodeAck(const Report& report, ReportId id = ReportId::Ack);

/// True when the CRC in bytes 62..63 is that of bytes 0..61.
[[nodiscard]] bool crcAgrees(const Report& report);

}  // namespace gonio::driver
