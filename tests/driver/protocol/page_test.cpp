// docs/protocol.md against the codec: every row of its tables of bytes is a field that is written
// there, and every field of the codec has its row. A field is set to marked bytes, encoded, and
// looked for at the offset that the page gives.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "driver/protocol/chunk.h"
#include "driver/protocol/crc.h"
#include "driver/protocol/pixels.h"
#include "driver/protocol/reports.h"

namespace gonio::driver {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Cells = std::vector<std::string>;

// ---- the page ----

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

Cells cellsOf(const std::string& row) {
    Cells cells;
    std::istringstream in(row.substr(1));
    for (std::string cell; std::getline(in, cell, '|');) cells.push_back(trimmed(cell));
    return cells;
}

/// The rows of the tables under each heading, without heads and rulers; a heading ends at its
/// colon.
std::map<std::string, std::vector<Cells>> tablesOfThePage() {
    std::ifstream in(GONIO_SOURCE_DIR "/docs/protocol.md");
    std::map<std::string, std::vector<Cells>> tables;
    std::string heading;
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("#")) {
            const std::string text = trimmed(line.substr(line.find_first_not_of('#')));
            heading = text.substr(0, text.find(':'));
        } else if (line.starts_with("|---")) {
            tables[heading].pop_back();  // what stood above was the head
        } else if (line.starts_with("|")) {
            tables[heading].push_back(cellsOf(line));
        }
    }
    return tables;
}

const std::vector<Cells>& rows(const std::string& heading) {
    static const auto tables = tablesOfThePage();
    static const std::vector<Cells> none;
    const auto found = tables.find(heading);
    EXPECT_NE(found, tables.end()) << "no table under '" << heading << "'";
    return found == tables.end() ? none : found->second;
}

// ---- the codec ----

template <class M>
struct TypeOf {
    static std::string name() {
        if constexpr (std::is_enum_v<M>) {
            return TypeOf<std::underlying_type_t<M>>::name();
        } else {
            return std::string(std::is_signed_v<M> ? "i" : "u") + std::to_string(8 * sizeof(M));
        }
    }
};
template <class Item, std::size_t N>
struct TypeOf<std::array<Item, N>> {
    static std::string name() { return TypeOf<Item>::name() + "[" + std::to_string(N) + "]"; }
};

/// Bytes that stand nowhere else.
Bytes marks(std::size_t count) {
    Bytes bytes;
    for (std::size_t i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(0xA1 + i));
    return bytes;
}

template <class T>
void setBytes(T& value, const Bytes& bytes, std::size_t at = 0) {
    if constexpr (std::is_enum_v<T>) {
        std::underlying_type_t<T> number{};
        setBytes(number, bytes, at);
        value = static_cast<T>(number);
    } else {
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) bits |= std::uint64_t{bytes[at + i]} << (8 * i);
        value = static_cast<T>(bits);
    }
}
template <class Item, std::size_t N>
void setBytes(std::array<Item, N>& value, const Bytes& bytes, std::size_t at = 0) {
    for (std::size_t i = 0; i < N; ++i) setBytes(value[i], bytes, at + i * sizeof(Item));
}

/// A field of the codec by its name on the page.
template <class T>
struct Field {
    std::string name, type;
    std::function<void(T&)> mark;
    Bytes wanted;  ///< then, at its offset
};

template <class T, class Owner, class M>
Field<T> field(const std::string& name, M Owner::*member) {
    const Bytes bytes = marks(sizeof(M));
    return {name, TypeOf<M>::name(), [member, bytes](T& v) { setBytes(v.*member, bytes); }, bytes};
}

/// Bytes that are the same whatever is encoded.
template <class T>
Field<T> constant(const std::string& name, const std::string& type, Bytes bytes) {
    return {name, type, [](T&) {}, std::move(bytes)};
}

template <class T>
struct Layout {
    std::string heading;
    std::function<Bytes(const T&)> encode;
    std::vector<Field<T>> fields;
    std::vector<std::size_t> sums;  ///< offsets of checksums, of 2 bytes in a report, else of 4
    T start{};
};

template <class T>
void expectAsOnThePage(const Layout<T>& layout) {
    SCOPED_TRACE(layout.heading);
    const auto& page = rows(layout.heading);
    const Bytes before = layout.encode(layout.start);
    std::vector<std::string> named;
    for (const Cells& row : page) {
        ASSERT_EQ(row.size(), 4U) << row.front();
        named.push_back(row[2]);
        const auto found = std::find_if(layout.fields.begin(),
                                        layout.fields.end(),
                                        [&](const Field<T>& f) { return f.name == row[2]; });
        ASSERT_NE(found, layout.fields.end()) << "the codec has no field " << row[2];
        EXPECT_EQ(row[1], found->type) << row[2];
        T value = layout.start;
        found->mark(value);
        const Bytes after = layout.encode(value);
        const std::size_t offset = std::stoul(row[0]);
        ASSERT_LE(offset + found->wanted.size(), after.size()) << row[2];
        const auto at = after.begin() + static_cast<std::ptrdiff_t>(offset);
        EXPECT_TRUE(std::equal(found->wanted.begin(), found->wanted.end(), at)) << row[2];
        for (std::size_t i = 0; i < after.size(); ++i) {
            const bool own = i >= offset && i < offset + found->wanted.size();
            const bool sum = std::any_of(layout.sums.begin(), layout.sums.end(), [&](auto s) {
                return i >= s && i < s + 4;
            });
            if (own || sum) continue;
            EXPECT_EQ(after[i], before[i]) << row[2] << " changes byte " << i;
        }
    }
    for (const Field<T>& one : layout.fields) {
        EXPECT_EQ(std::count(named.begin(), named.end(), one.name), 1) << "the row of " << one.name;
    }
}

template <class T>
Layout<T> report(const std::string& heading, std::vector<Field<T>> fields) {
    return {heading,
            [](const T& v) {
                const Report bytes = encode(v);
                return Bytes(bytes.begin(), bytes.end());
            },
            std::move(fields),
            {62},
            {}};
}

template <class T>
Layout<T> payload(const std::string& heading, std::vector<Field<T>> fields) {
    return {heading,
            [](const T& v) {
                const auto bytes = encode(v);
                return Bytes(bytes.begin(), bytes.end());
            },
            std::move(fields),
            {},
            {}};
}

// ---- reports ----

TEST(ProtocolPage, IdentIsTheCodecs) {
    using T = Ident;
    expectAsOnThePage(report<T>("IDENT",
                                {field<T>("major", &T::major),
                                 field<T>("minor", &T::minor),
                                 field<T>("hw_rev", &T::hardwareRevision),
                                 field<T>("firmware", &T::firmware),
                                 field<T>("capabilities", &T::capabilities),
                                 field<T>("boot_id", &T::bootId),
                                 field<T>("sensor_width", &T::sensorWidth),
                                 field<T>("sensor_height", &T::sensorHeight),
                                 field<T>("bit_depth", &T::bitDepth),
                                 field<T>("led_count", &T::ledCount),
                                 field<T>("led_angle", &T::ledAngle),
                                 field<T>("wavelength_nm", &T::wavelengthNm),
                                 field<T>("max_chunk_payload", &T::maxChunkPayload),
                                 field<T>("frame_ram", &T::frameRam),
                                 field<T>("exposure_min_us", &T::exposureMinUs),
                                 field<T>("exposure_max_us", &T::exposureMaxUs),
                                 field<T>("exposure_step", &T::exposureStep),
                                 field<T>("control_latency", &T::controlLatency),
                                 field<T>("led_settle_ms", &T::ledSettleMs)}));
}

TEST(ProtocolPage, SessionIsTheCodecs) {
    using Set = SessionSet;
    expectAsOnThePage(report<Set>("SESSION set",
                                  {field<Set>("session_id", &Set::sessionId),
                                   field<Set>("heartbeat_ms", &Set::heartbeatMs),
                                   field<Set>("host_minor", &Set::hostMinor),
                                   {"action", "u8", [](Set& v) { v.release = true; }, Bytes{1}}}));
    using T = SessionState;
    expectAsOnThePage(report<T>("SESSION get",
                                {field<T>("session_id", &T::sessionId),
                                 field<T>("heartbeat_ms", &T::heartbeatMs),
                                 field<T>("host_minor", &T::hostMinor),
                                 field<T>("status", &T::statusOfLastSet),
                                 field<T>("last_cmd_seq", &T::lastCommand),
                                 field<T>("owner", &T::owner)}));
}

TEST(ProtocolPage, EventsAreTheCodecs) {
    struct From {
        std::uint32_t sequence = 0;
    };
    expectAsOnThePage(Layout<From>{"EVENTS set",
                                   [](const From& v) {
                                       const Report bytes = encodeEventsFrom(v.sequence);
                                       return Bytes(bytes.begin(), bytes.end());
                                   },
                                   {field<From>("from_seq", &From::sequence)},
                                   {62},
                                   {}});
    using T = EventsPage;
    const auto of = [](std::size_t i, const std::string& which) {
        const auto one = [&](const std::string& name, auto member) {
            Field<Event> inner = field<Event>(name, member);
            return Field<T>{which + name,
                            inner.type,
                            [i, mark = inner.mark](T& v) { mark(v.events[i]); },
                            inner.wanted};
        };
        return std::vector<Field<T>>{one("event_seq", &Event::sequence),
                                     one("t_us", &Event::timeUs),
                                     one("code", &Event::code),
                                     one("arg0", &Event::arg0),
                                     one("arg1", &Event::arg1)};
    };
    Layout<T> page = report<T>(
        "EVENTS get", {field<T>("oldest_seq", &T::oldest), field<T>("newest_seq", &T::newest)});
    page.start.events.resize(2);
    page.fields.push_back(constant<T>("count", "u8", {2}));
    for (auto& one : of(0, "first.")) page.fields.push_back(one);
    for (auto& one : of(1, "second.")) page.fields.push_back(one);
    expectAsOnThePage(page);
    expectAsOnThePage(report<Event>("EVENT",
                                    {field<Event>("event_seq", &Event::sequence),
                                     field<Event>("t_us", &Event::timeUs),
                                     field<Event>("code", &Event::code),
                                     field<Event>("arg0", &Event::arg0),
                                     field<Event>("arg1", &Event::arg1)}));
}

TEST(ProtocolPage, StatsAndLimitsAreTheCodecs) {
    using S = Stats;
    expectAsOnThePage(report<S>("STATS",
                                {field<S>("uptime_s", &S::uptimeS),
                                 field<S>("fifo_overruns", &S::fifoOverruns),
                                 field<S>("crc_rejects", &S::crcRejects),
                                 field<S>("resends", &S::resends),
                                 field<S>("frames_made", &S::framesMade),
                                 field<S>("frames_gone", &S::framesGone),
                                 field<S>("commands_done", &S::commandsDone),
                                 field<S>("replays", &S::replays),
                                 field<S>("lapses", &S::lapses)}));
    using T = Limits;
    expectAsOnThePage(report<T>("LIMITS",
                                {field<T>("formats", &T::formats),
                                 field<T>("binnings", &T::binnings),
                                 field<T>("roi_step", &T::roiStep),
                                 field<T>("max_frames", &T::maxFrames),
                                 field<T>("frame_period_us", &T::framePeriodUs),
                                 field<T>("gain_max", &T::gainMax),
                                 field<T>("black_level", &T::blackLevel),
                                 field<T>("full_scale", &T::fullScale),
                                 field<T>("led_full", &T::ledFull),
                                 field<T>("led_white", &T::ledWhite),
                                 field<T>("led_tolerance", &T::ledTolerance),
                                 field<T>("led_temperature", &T::ledTemperature),
                                 field<T>("sensor_temperature", &T::sensorTemperature)}));
}

TEST(ProtocolPage, StatusIsTheCodecs) {
    using T = Status;
    expectAsOnThePage(report<T>("STATUS",
                                {field<T>("seq", &T::sequence),
                                 field<T>("boot_id", &T::bootId),
                                 field<T>("t_us", &T::timeUs),
                                 field<T>("state", &T::state),
                                 field<T>("interlock", &T::interlock),
                                 field<T>("led_on", &T::ledOn),
                                 field<T>("led_current", &T::ledCurrent),
                                 field<T>("temperature", &T::temperature),
                                 field<T>("last_cmd_seq", &T::lastCommand),
                                 field<T>("capture_id", &T::captureId),
                                 field<T>("frames_made", &T::framesMade),
                                 field<T>("fifo_frames", &T::fifoFrames),
                                 field<T>("newest_event_seq", &T::newestEvent),
                                 field<T>("fault", &T::fault),
                                 field<T>("owner", &T::owner)}));
}

TEST(ProtocolPage, CommandAndAckAreTheCodecs) {
    using C = Command;
    expectAsOnThePage(report<C>("COMMAND",
                                {field<C>("session_low", &C::sessionLow),
                                 field<C>("cmd_seq", &C::sequence),
                                 field<C>("op", &C::op),
                                 constant<C>("flags", "u8", {0}),
                                 field<C>("arguments", &C::arguments)}));
    using T = Ack;
    const std::vector<Field<T>> fields{field<T>("cmd_seq", &T::sequence),
                                       field<T>("op", &T::op),
                                       field<T>("status", &T::status),
                                       field<T>("retry_ms", &T::retryMs),
                                       field<T>("result", &T::result),
                                       field<T>("session_low", &T::sessionLow)};
    expectAsOnThePage(report<T>("ACK", fields));
}

TEST(ProtocolPage, ArgumentsAndResultsAreTheCodecs) {
    expectAsOnThePage(payload<SetLed>(
        "SET_LED arguments",
        {field<SetLed>("led", &SetLed::led), field<SetLed>("levels", &SetLed::levels)}));
    expectAsOnThePage(
        payload<SetExposure>("SET_EXPOSURE arguments",
                             {field<SetExposure>("exposure_us", &SetExposure::exposureUs),
                              field<SetExposure>("gain", &SetExposure::gain)}));
    expectAsOnThePage(
        payload<Granted>("GRANTED result",
                         {field<Granted>("granted_ns", &Granted::exposureNs),
                          field<Granted>("granted_gain", &Granted::gain),
                          field<Granted>("effective_frame", &Granted::effectiveFrame)}));
    using F = SetFormat;
    expectAsOnThePage(payload<F>("SET_FORMAT arguments",
                                 {field<F>("pixel_format", &F::format),
                                  field<F>("x", &F::x),
                                  field<F>("y", &F::y),
                                  field<F>("w", &F::width),
                                  field<F>("h", &F::height),
                                  field<F>("binning", &F::binning)}));
    expectAsOnThePage(payload<Arm>("ARM arguments",
                                   {field<Arm>("capture_id", &Arm::captureId),
                                    field<Arm>("frames", &Arm::frames),
                                    field<Arm>("trigger", &Arm::trigger)}));
    using R = Resend;
    expectAsOnThePage(payload<R>("RESEND arguments",
                                 {field<R>("capture_id", &R::captureId),
                                  field<R>("frame", &R::frame),
                                  field<R>("first_chunk", &R::firstChunk),
                                  field<R>("last_chunk", &R::lastChunk)}));
}

// ---- chunks ----

const Bytes kPayload{'1', '2', '3', '4', '5', '6', '7', '8', '9'};

TEST(ProtocolPage, ChunkHeaderIsTheCodecs) {
    using T = ChunkHeader;
    const auto header = [](const T& v) {
        Bytes chunk = encodeChunk(v, kPayload);
        chunk.resize(kChunkHeaderBytes);
        return chunk;
    };
    const Bytes plain = header({});
    const std::uint32_t sum = crc32c(std::span(plain).first(60));
    Bytes headerCrc;
    for (int shift = 0; shift < 32; shift += 8)
        headerCrc.push_back(static_cast<std::uint8_t>(sum >> shift));
    expectAsOnThePage(
        Layout<T>{"Chunk header",
                  header,
                  {constant<T>("magic", "u8[4]", {'G', 'N', 'F', '1'}),
                   constant<T>("version", "u8", {1}),
                   field<T>("type", &T::type),
                   constant<T>("header_len", "u16", {64, 0}),
                   field<T>("boot_id", &T::bootId),
                   field<T>("stream_seq", &T::streamSequence),
                   field<T>("capture_id", &T::captureId),
                   field<T>("frame_index", &T::frameIndex),
                   field<T>("chunk_index", &T::chunkIndex),
                   field<T>("chunk_count", &T::chunkCount),
                   {"flags", "u16", [](T& v) { v.resent = true; }, Bytes{1, 0}},
                   field<T>("offset", &T::offset),
                   constant<T>("length", "u32", {9, 0, 0, 0}),
                   field<T>("t_us", &T::timeUs),
                   constant<T>("payload_crc", "u32", {0x83, 0x92, 0x06, 0xE3}),  // check value
                   constant<T>("reserved", "u8[8]", Bytes(8, 0)),
                   constant<T>("header_crc", "u32", headerCrc)},
                  {60},
                  {}});
}

TEST(ProtocolPage, PayloadsAreTheCodecs) {
    using L = Leader;
    expectAsOnThePage(payload<L>("LEADER payload",
                                 {field<L>("width", &L::width),
                                  field<L>("height", &L::height),
                                  field<L>("stride", &L::stride),
                                  field<L>("pixel_format", &L::format),
                                  field<L>("led", &L::led),
                                  field<L>("channels", &L::channels),
                                  field<L>("bit_depth", &L::bitDepth),
                                  field<L>("exposure_requested_us", &L::exposureRequestedUs),
                                  field<L>("exposure_granted_ns", &L::exposureGrantedNs),
                                  field<L>("gain", &L::gain),
                                  field<L>("led_level", &L::ledLevel),
                                  field<L>("temperature", &L::temperature),
                                  field<L>("black_level", &L::blackLevel),
                                  field<L>("x", &L::x),
                                  field<L>("y", &L::y),
                                  field<L>("binning", &L::binning),
                                  field<L>("frame_bytes", &L::frameBytes),
                                  field<L>("exposure_start_us", &L::exposureStartUs),
                                  field<L>("frame_number", &L::frameNumber)}));
    using T = Trailer;
    expectAsOnThePage(payload<T>("TRAILER payload",
                                 {field<T>("frame_bytes", &T::frameBytes),
                                  field<T>("frame_crc", &T::frameCrc),
                                  field<T>("exposure_end_us", &T::exposureEndUs),
                                  field<T>("current_min", &T::currentMin),
                                  field<T>("current_max", &T::currentMax),
                                  field<T>("validity", &T::validity),
                                  field<T>("saturated_pixels", &T::saturatedPixels)}));
    using A = Aborted;
    expectAsOnThePage(
        payload<A>("ABORTED payload",
                   {field<A>("reason", &A::reason), field<A>("frame_number", &A::frameNumber)}));
    EXPECT_EQ(encode(L{}).size(), 64U);
    EXPECT_EQ(encode(T{}).size(), 64U);
    EXPECT_EQ(encode(A{}).size(), 8U);
}

// ---- numbers and vectors ----

TEST(ProtocolPage, CommandsAndStatusesHaveTheirNumbers) {
    const auto& commands = rows("Commands");
    ASSERT_EQ(commands.size(), 12U);
    for (const Cells& row : commands) {
        EXPECT_EQ(opName(static_cast<Op>(std::stoi(row[0], nullptr, 16))), row[1]);
    }
    const auto& statuses = rows("Statuses");
    ASSERT_EQ(statuses.size(), 20U);
    for (const Cells& row : statuses) {
        EXPECT_EQ(statusName(static_cast<std::uint16_t>(std::stoi(row[0]))), row[1]);
    }
}

TEST(ProtocolPage, EventCodesHaveTheirNumbers) {
    const std::map<std::string, std::uint16_t> codes{
        {"boot", event::kBoot},
        {"interlock opened", event::kInterlockOpened},
        {"interlock closed", event::kInterlockClosed},
        {"over-temperature", event::kOverTemp},
        {"temperature back in range", event::kTemperatureBack},
        {"LED open circuit", event::kLedOpen},
        {"LED drift", event::kLedDrift},
        {"frame skipped, frame RAM full", event::kOverrun},
        {"heartbeat lost, LEDs were darkened", event::kHeartbeatLost},
        {"module attached", event::kModuleAttached},
        {"module removed", event::kModuleRemoved},
        {"session claimed", event::kClaimed},
        {"session ended", event::kEnded},
        {"link lost", event::kLinkLost}};
    const auto& page = rows("Event codes");
    ASSERT_EQ(page.size(), codes.size());
    for (const Cells& row : page) {
        const auto found = codes.find(row[1]);
        ASSERT_NE(found, codes.end()) << row[1];
        EXPECT_EQ(std::to_string(found->second), row[0]) << row[1];
    }
}

/// "20 88 .. 5F 5C", "21 [52] 88 .. 5F F4": of 64 bytes where zeros are left out.
Bytes vectorOfThePage(const std::string& cell) {
    std::istringstream in(cell.substr(1, cell.size() - 2));  // between backquotes
    Bytes bytes;
    bool tail = false;
    Bytes last;
    for (std::string word; in >> word;) {
        if (word == "..") {
            tail = true;
        } else if (word.starts_with("[")) {
            bytes.resize(std::stoul(word.substr(1)));
        } else {
            (tail ? last : bytes)
                .push_back(static_cast<std::uint8_t>(std::stoi(word, nullptr, 16)));
        }
    }
    if (!tail) return bytes;
    bytes.resize(kReportBytes - last.size());
    bytes.insert(bytes.end(), last.begin(), last.end());
    return bytes;
}

Bytes bytesOf(const Report& report) { return {report.begin(), report.end()}; }

TEST(ProtocolPage, VectorsAreWhatTheCodecWrites) {
    constexpr std::uint64_t kTime = 1234567;
    Bytes header = encodeChunk({.type = ChunkType::Data,
                                .bootId = 0xB0071D01,
                                .streamSequence = 42,
                                .captureId = 0x0102030405060708,
                                .frameIndex = 3,
                                .chunkIndex = 1,
                                .chunkCount = 8,
                                .timeUs = kTime},
                               kPayload);
    header.resize(kChunkHeaderBytes);
    const Bytes leader = encode(Leader{.width = 3,
                                       .height = 2,
                                       .stride = 5,
                                       .format = PixelFormat::Mono12Packed,
                                       .led = 2,
                                       .channels = 1,
                                       .bitDepth = 12,
                                       .exposureRequestedUs = 1000,
                                       .exposureGrantedNs = 1004260,
                                       .ledLevel = {65535, 0, 0},
                                       .temperature = {2600, 2900, 2500, 2300},
                                       .blackLevel = 60,
                                       .binning = 1,
                                       .frameBytes = 10,
                                       .exposureStartUs = kTime,
                                       .frameNumber = 7});
    const Bytes pixels = packPixels(
        Image<std::uint16_t>({3, 2}, std::vector<std::uint16_t>{0xABC, 0x123, 0xDEF, 1, 2, 3}),
        PixelFormat::Mono12Packed);
    const std::map<std::string, Bytes> vectors{
        {"SESSION set", bytesOf(encode(SessionSet{.sessionId = 0x1122334455667788}))},
        {"COMMAND",
         bytesOf(encode(Command{.sessionLow = 0x55667788,
                                .sequence = 1,
                                .op = Op::SetLed,
                                .arguments = encode(SetLed{.led = 2, .levels = {65535, 0, 0}})}))},
        {"ACK",
         bytesOf(encode(Ack{
             .sequence = 1, .op = Op::SetLed, .result = encodeU32(7), .sessionLow = 0x55667788}))},
        {"EVENT",
         bytesOf(encode(Event{.sequence = 5, .timeUs = kTime, .code = 2, .arg0 = 1, .arg1 = 7}))},
        {"chunk header", header},
        {"LEADER", leader},
        {"pixels", pixels}};
    const auto& page = rows("5. Versions and vectors");
    ASSERT_EQ(page.size(), vectors.size());
    for (const Cells& row : page) {
        const auto found = vectors.find(row[0]);
        ASSERT_NE(found, vectors.end()) << row[0];
        EXPECT_EQ(vectorOfThePage(row[2]), found->second) << row[0];
    }
    EXPECT_EQ(crc32c(leader), 0x1E0CB1A3U);
    EXPECT_EQ(crc32c(pixels), 0xB4ED3658U);
}

}  // namespace
}  // namespace gonio::driver
