#include "driver/protocol/reports.h"

#include <algorithm>
#include <string>
#include <type_traits>

#include "driver/protocol/crc.h"
#include "driver/protocol/wire.h"

namespace gonio::driver {
namespace {

constexpr std::size_t kCrcOffset = 62;

// A layout is one function over the fields of a struct, in the order of the wire. The same function
// writes and reads them, so that the two directions cannot disagree.

class Writer {
public:
    explicit Writer(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

    template <class T>
    void field(std::size_t offset, const T& value) {
        if constexpr (std::is_enum_v<T>) {
            put(bytes_, offset, static_cast<std::underlying_type_t<T>>(value));
        } else if constexpr (std::is_integral_v<T>) {
            put(bytes_, offset, value);
        } else {
            for (const auto& item : value) {
                put(bytes_, offset, item);
                offset += sizeof(item);
            }
        }
    }

private:
    std::span<std::uint8_t> bytes_;
};

class Reader {
public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    template <class T>
    void field(std::size_t offset, T& value) {
        if constexpr (std::is_enum_v<T>) {
            value = static_cast<T>(get<std::underlying_type_t<T>>(bytes_, offset));
        } else if constexpr (std::is_integral_v<T>) {
            value = get<T>(bytes_, offset);
        } else {
            for (auto& item : value) {
                item = get<std::remove_reference_t<decltype(item)>>(bytes_, offset);
                offset += sizeof(item);
            }
        }
    }

private:
    std::span<const std::uint8_t> bytes_;
};

template <class IO, class T>
void layoutIdent(IO& io, T& v) {
    io.field(1, v.major);
    io.field(2, v.minor);
    io.field(3, v.hardwareRevision);
    io.field(4, v.firmware);
    io.field(8, v.capabilities);
    io.field(12, v.bootId);
    io.field(16, v.sensorWidth);
    io.field(18, v.sensorHeight);
    io.field(20, v.bitDepth);
    io.field(21, v.ledCount);
    io.field(22, v.ledAngle);
    io.field(38, v.wavelengthNm);
    io.field(44, v.maxChunkPayload);
    io.field(48, v.frameRam);
    io.field(50, v.exposureMinUs);
    io.field(54, v.exposureMaxUs);
    io.field(58, v.exposureStep);
    io.field(60, v.controlLatency);
    io.field(61, v.ledSettleMs);
}

template <class IO, class T>
void layoutStats(IO& io, T& v) {
    io.field(1, v.uptimeS);
    io.field(5, v.fifoOverruns);
    io.field(9, v.crcRejects);
    io.field(13, v.resends);
    io.field(17, v.framesMade);
    io.field(21, v.framesGone);
    io.field(25, v.commandsDone);
    io.field(29, v.replays);
    io.field(33, v.lapses);
}

template <class IO, class T>
void layoutLimits(IO& io, T& v) {
    io.field(1, v.formats);
    io.field(2, v.binnings);
    io.field(3, v.roiStep);
    io.field(4, v.maxFrames);
    io.field(6, v.framePeriodUs);
    io.field(10, v.gainMax);
    io.field(12, v.blackLevel);
    io.field(14, v.fullScale);
    io.field(16, v.ledFull);
    io.field(22, v.ledWhite);
    io.field(28, v.ledTolerance);
    io.field(30, v.ledTemperature);
    io.field(34, v.sensorTemperature);
}

template <class IO, class T>
void layoutStatus(IO& io, T& v) {
    io.field(1, v.sequence);
    io.field(3, v.bootId);
    io.field(7, v.timeUs);
    io.field(15, v.state);
    io.field(16, v.interlock);
    io.field(17, v.ledOn);
    io.field(21, v.ledCurrent);
    io.field(27, v.temperature);
    io.field(35, v.lastCommand);
    io.field(37, v.captureId);
    io.field(45, v.framesMade);
    io.field(49, v.fifoFrames);
    io.field(51, v.newestEvent);
    io.field(55, v.fault);
    io.field(57, v.owner);
}

template <class IO, class T>
void layoutEvent(IO& io, T& v) {
    io.field(1, v.sequence);
    io.field(5, v.timeUs);
    io.field(13, v.code);
    io.field(15, v.arg0);
    io.field(19, v.arg1);
}

template <class IO, class T>
void layoutSessionState(IO& io, T& v) {
    io.field(1, v.sessionId);
    io.field(9, v.heartbeatMs);
    io.field(11, v.hostMinor);
    io.field(12, v.statusOfLastSet);
    io.field(14, v.lastCommand);
    io.field(16, v.owner);
}

template <class IO, class T>
void layoutSetLed(IO& io, T& v) {
    io.field(0, v.led);
    io.field(1, v.levels);
}

template <class IO, class T>
void layoutSetExposure(IO& io, T& v) {
    io.field(0, v.exposureUs);
    io.field(4, v.gain);
}

template <class IO, class T>
void layoutGranted(IO& io, T& v) {
    io.field(0, v.exposureNs);
    io.field(8, v.gain);
    io.field(10, v.effectiveFrame);
}

template <class IO, class T>
void layoutSetFormat(IO& io, T& v) {
    io.field(0, v.format);
    io.field(1, v.x);
    io.field(3, v.y);
    io.field(5, v.width);
    io.field(7, v.height);
    io.field(9, v.binning);
}

template <class IO, class T>
void layoutArm(IO& io, T& v) {
    io.field(0, v.captureId);
    io.field(8, v.frames);
    io.field(10, v.trigger);
}

template <class IO, class T>
void layoutResend(IO& io, T& v) {
    io.field(0, v.captureId);
    io.field(8, v.frame);
    io.field(10, v.firstChunk);
    io.field(12, v.lastChunk);
}

template <class IO, class T>
void layoutSessionSet(IO& io, T& v) {
    io.field(1, v.sessionId);
    io.field(9, v.heartbeatMs);
    io.field(11, v.hostMinor);
}

template <class IO, class T>
void layoutCommand(IO& io, T& v) {
    io.field(1, v.sessionLow);
    io.field(5, v.sequence);
    io.field(7, v.op);
    io.field(9, v.arguments);
}

template <class IO, class T>
void layoutAck(IO& io, T& v) {
    io.field(1, v.sequence);
    io.field(3, v.op);
    io.field(4, v.status);
    io.field(6, v.retryMs);
    io.field(8, v.result);
    io.field(52, v.sessionLow);
}

// An event inside an EVENTS page: the Event report without its id.
constexpr std::size_t kPagedEvent = 10;
constexpr std::size_t kPagedEventBytes = 22;

Report sealed(ReportId id, Report report) {
    report[0] = static_cast<std::uint8_t>(id);
    put(std::span(report), kCrcOffset, crc16(std::span(report).first(kCrcOffset)));
    return report;
}

std::optional<Error> wrong(const Report& report, ReportId id, const char* name) {
    if (report[0] != static_cast<std::uint8_t>(id)) {
        return Error{ErrorKind::Device,
                     std::string("report ") + name + ": id " + std::to_string(report[0]) +
                         ", wanted " + std::to_string(static_cast<int>(id))};
    }
    if (!crcAgrees(report)) {
        return Error{ErrorKind::Device, std::string("report ") + name + ": CRC does not agree"};
    }
    return std::nullopt;
}

template <class T, class Layout>
Result<T> decodeReport(const Report& report, ReportId id, const char* name, Layout layout) {
    if (auto error = wrong(report, id, name)) return *error;
    T value;
    Reader reader{report};
    layout(reader, value);
    return value;
}

template <class T, class Layout>
Report encodeReport(ReportId id, const T& value, Layout layout) {
    Report report{};
    Writer writer{report};
    layout(writer, value);
    return sealed(id, report);
}

template <class T, class Layout>
Arguments encodeArguments(const T& value, Layout layout) {
    Arguments bytes{};
    Writer writer{bytes};
    layout(writer, value);
    return bytes;
}

template <class T, class Layout>
T decodeArguments(const Arguments& bytes, Layout layout) {
    T value;
    Reader reader{bytes};
    layout(reader, value);
    return value;
}

}  // namespace

bool crcAgrees(const Report& report) {
    return get<std::uint16_t>(report, kCrcOffset) == crc16(std::span(report).first(kCrcOffset));
}

Arguments encode(const SetLed& v) {
    return encodeArguments(v, [](auto& io, auto& it) { layoutSetLed(io, it); });
}
SetLed decodeSetLed(const Arguments& bytes) {
    return decodeArguments<SetLed>(bytes, [](auto& io, auto& it) { layoutSetLed(io, it); });
}

Arguments encode(const SetExposure& v) {
    return encodeArguments(v, [](auto& io, auto& it) { layoutSetExposure(io, it); });
}
SetExposure decodeSetExposure(const Arguments& bytes) {
    return decodeArguments<SetExposure>(bytes,
                                        [](auto& io, auto& it) { layoutSetExposure(io, it); });
}

Arguments encode(const Granted& v) {
    return encodeArguments(v, [](auto& io, auto& it) { layoutGranted(io, it); });
}
Granted decodeGranted(const Arguments& bytes) {
    return decodeArguments<Granted>(bytes, [](auto& io, auto& it) { layoutGranted(io, it); });
}

Arguments encode(const SetFormat& v) {
    return encodeArguments(v, [](auto& io, auto& it) { layoutSetFormat(io, it); });
}
SetFormat decodeSetFormat(const Arguments& bytes) {
    return decodeArguments<SetFormat>(bytes, [](auto& io, auto& it) { layoutSetFormat(io, it); });
}

Arguments encode(const Arm& v) {
    return encodeArguments(v, [](auto& io, auto& it) { layoutArm(io, it); });
}
Arm decodeArm(const Arguments& bytes) {
    return decodeArguments<Arm>(bytes, [](auto& io, auto& it) { layoutArm(io, it); });
}

Arguments encode(const Resend& v) {
    return encodeArguments(v, [](auto& io, auto& it) { layoutResend(io, it); });
}
Resend decodeResend(const Arguments& bytes) {
    return decodeArguments<Resend>(bytes, [](auto& io, auto& it) { layoutResend(io, it); });
}

Arguments encodeU32(std::uint32_t v) {
    Arguments bytes{};
    put(std::span(bytes), 0, v);
    return bytes;
}
Arguments encodeU64(std::uint64_t v) {
    Arguments bytes{};
    put(std::span(bytes), 0, v);
    return bytes;
}
std::uint32_t decodeU32(const Arguments& bytes) { return get<std::uint32_t>(bytes, 0); }
std::uint64_t decodeU64(const Arguments& bytes) { return get<std::uint64_t>(bytes, 0); }

Report encode(const Ident& v) {
    return encodeReport(ReportId::Ident, v, [](auto& io, auto& it) { layoutIdent(io, it); });
}
Result<Ident> decodeIdent(const Report& report) {
    return decodeReport<Ident>(
        report, ReportId::Ident, "IDENT", [](auto& io, auto& it) { layoutIdent(io, it); });
}

Report encode(const Stats& v) {
    return encodeReport(ReportId::Stats, v, [](auto& io, auto& it) { layoutStats(io, it); });
}
Result<Stats> decodeStats(const Report& report) {
    return decodeReport<Stats>(
        report, ReportId::Stats, "STATS", [](auto& io, auto& it) { layoutStats(io, it); });
}

Report encode(const Limits& v) {
    return encodeReport(ReportId::Limits, v, [](auto& io, auto& it) { layoutLimits(io, it); });
}
Result<Limits> decodeLimits(const Report& report) {
    return decodeReport<Limits>(
        report, ReportId::Limits, "LIMITS", [](auto& io, auto& it) { layoutLimits(io, it); });
}

Report encode(const Status& v) {
    return encodeReport(ReportId::Status, v, [](auto& io, auto& it) { layoutStatus(io, it); });
}
Result<Status> decodeStatus(const Report& report) {
    return decodeReport<Status>(
        report, ReportId::Status, "STATUS", [](auto& io, auto& it) { layoutStatus(io, it); });
}

Report encode(const Event& v) {
    return encodeReport(ReportId::Event, v, [](auto& io, auto& it) { layoutEvent(io, it); });
}
Result<Event> decodeEvent(const Report& report) {
    return decodeReport<Event>(
        report, ReportId::Event, "EVENT", [](auto& io, auto& it) { layoutEvent(io, it); });
}

Report encode(const SessionState& v) {
    return encodeReport(
        ReportId::Session, v, [](auto& io, auto& it) { layoutSessionState(io, it); });
}
Result<SessionState> decodeSessionState(const Report& report) {
    return decodeReport<SessionState>(report, ReportId::Session, "SESSION", [](auto& io, auto& it) {
        layoutSessionState(io, it);
    });
}

Report encode(const Command& v) {
    return encodeReport(ReportId::Command, v, [](auto& io, auto& it) { layoutCommand(io, it); });
}
Result<Command> decodeCommand(const Report& report) {
    return decodeReport<Command>(
        report, ReportId::Command, "COMMAND", [](auto& io, auto& it) { layoutCommand(io, it); });
}

Report encode(const SessionSet& v) {
    Report report{};
    Writer writer{report};
    layoutSessionSet(writer, v);
    report[12] = v.release ? 1 : 0;
    return sealed(ReportId::Session, report);
}
Result<SessionSet> decodeSessionSet(const Report& report) {
    if (auto error = wrong(report, ReportId::Session, "SESSION")) return *error;
    if (report[12] > 1) {
        return Error{ErrorKind::Device,
                     "report SESSION: action " + std::to_string(report[12]) + ", wanted 0 or 1",
                     status::kBadArg};
    }
    SessionSet value;
    Reader reader{report};
    layoutSessionSet(reader, value);
    value.release = report[12] == 1;
    return value;
}

Report encode(const EventsPage& v) {
    Report report{};
    Writer writer{report};
    writer.field(1, v.oldest);
    writer.field(5, v.newest);
    const std::size_t count = std::min<std::size_t>(v.events.size(), 2);
    report[9] = static_cast<std::uint8_t>(count);
    for (std::size_t i = 0; i < count; ++i) {
        Writer paged{std::span(report).subspan(kPagedEvent - 1 + i * kPagedEventBytes)};
        layoutEvent(paged, v.events[i]);
    }
    return sealed(ReportId::Events, report);
}
Result<EventsPage> decodeEventsPage(const Report& report) {
    if (auto error = wrong(report, ReportId::Events, "EVENTS")) return *error;
    if (report[9] > 2) {
        return Error{ErrorKind::Device,
                     "report EVENTS: count " + std::to_string(report[9]) + ", wanted at most 2"};
    }
    EventsPage page;
    Reader reader{report};
    reader.field(1, page.oldest);
    reader.field(5, page.newest);
    page.events.resize(report[9]);
    for (std::size_t i = 0; i < page.events.size(); ++i) {
        Reader paged{std::span(report).subspan(kPagedEvent - 1 + i * kPagedEventBytes)};
        layoutEvent(paged, page.events[i]);
    }
    return page;
}

Report encodeEventsFrom(std::uint32_t fromSequence) {
    Report report{};
    put(std::span(report), 1, fromSequence);
    return sealed(ReportId::Events, report);
}
Result<std::uint32_t> decodeEventsFrom(const Report& report) {
    if (auto error = wrong(report, ReportId::Events, "EVENTS")) return *error;
    return get<std::uint32_t>(report, 1);
}

Report encode(const Ack& v, ReportId id) {
    return encodeReport(id, v, [](auto& io, auto& ack) { layoutAck(io, ack); });
}
Result<Ack> decodeAck(const Report& report, ReportId id) {
    return decodeReport<Ack>(report, id, "ACK", [](auto& io, auto& ack) { layoutAck(io, ack); });
}

}  // namespace gonio::driver
