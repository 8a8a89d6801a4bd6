// What the driver reads of a rig that may say anything, for libFuzzer (formats_fuzz.cpp): reports,
// transfers through the assembler, descriptors, recordings with a host upon them; the simulator's
// fault scripts, and what its USB/IP server is told. The seeds are what the simulated rig says.
// Bytes behind a checksum are tried as they are and with the checksum put right, or nothing would
// be read behind it.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>

#include "driver/assembler.h"
#include "driver/protocol/crc.h"
#include "driver/protocol/wire.h"
#include "driver/recorder.h"
#include "driver/replay.h"
#include "driver/rig.h"
#include "sim/faults/fault_script.h"
#include "sim/in_process.h"
#include "tests/formats/readers.h"
#include "tests/fuzz/usb_readers.h"

namespace gonio::test {
namespace {

using namespace driver;
namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kSession = 0x1122334455667788;
constexpr Window kWindow{.x = 512, .y = 384, .size = {16, 16}, .binning = 1};

/// What a host does with any rig.
void host(Transport& transport, const std::function<void(const Frame&)>& look = {}) {
    auto rig = Rig::open(transport, kSession);
    if (!rig || !rig->configure(kWindow)) return;
    const auto request = [](std::uint64_t step) {
        return CaptureRequest{.planStep = step,
                              .led = 1,
                              .levels = LedLevels::only(Band::G, 65535),
                              .exposure = Microseconds(320),
                              .frames = 2};
    };
    for (const std::uint64_t step : {1U, 2U}) {
        const auto capture = rig->capture(request(step), {.next = request(step + 1)});
        if (!capture) continue;
        for (const Frame& frame : *capture)
            if (look) look(frame);
    }
    (void)rig->link().takeEvents();
    (void)rig->status();
    (void)rig->link().stats();
}

std::string recorded() {
    const fs::path file = fs::temp_directory_path() / ("gonio_seed_" + std::to_string(getpid()));
    {
        sim::InProcessDoor door(sim::DeviceConfig{.errors = {}});
        auto recorder = Recorder::open(file);
        if (!recorder) return {};
        RecordingTransport transport(door, **recorder);
        host(transport);
    }
    std::ifstream in(file, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(in), {});
    fs::remove(file);
    return bytes;
}

std::vector<RecordedCall> calls() {
    std::vector<RecordedCall> all;
    const std::string bytes = recorded();
    auto reader = RecordingReader::open(std::make_unique<std::istringstream>(bytes), bytes.size());
    while (reader) {
        auto call = reader->next();
        if (!call || !*call) break;
        all.push_back(std::move(**call));
    }
    return all;
}

// ---- reports

std::vector<std::string> soundReports() {
    std::vector<std::string> all;
    for (const RecordedCall& call : calls()) {
        if (call.sent.size() == kReportBytes) all.push_back(textOf(call.sent));
        if (call.got.size() == kReportBytes) all.push_back(textOf(call.got));
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

/// What has been read is written and read again.
template <class T, class Decode>
bool staysTheSame(const Result<T>& read, Decode decode) {
    if (!read) return true;
    const auto again = decode(encode(*read));
    return again && *again == *read;
}

std::optional<Error> readReport(const Report& report) {
    (void)crcAgrees(report);
    (void)decodeIdent(report);
    (void)decodeSessionState(report);
    (void)decodeEventsPage(report);
    (void)decodeEventsFrom(report);
    (void)decodeStats(report);
    (void)decodeLimits(report);
    (void)decodeStatus(report);
    (void)decodeAck(report, ReportId::LastAck);
    const bool same = staysTheSame(decodeSessionSet(report), decodeSessionSet) &&
                      staysTheSame(decodeEvent(report), decodeEvent) &&
                      staysTheSame(decodeCommand(report), decodeCommand);
    if (!same) return wrong("a report that was written again reads otherwise");
    return std::nullopt;
}

std::optional<Error> readReports(std::string_view text) {
    Report report{};
    std::copy_n(text.begin(), std::min(text.size(), report.size()), report.begin());
    if (auto complaint = readReport(report)) return complaint;
    put(std::span(report), 62, crc16(std::span(report).first(62)));
    return readReport(report);
}

// ---- transfers, each after a byte of what is done with it and two of its length

enum Deed : std::uint8_t {
    Seal = 1,
    AskAgain = 2,
    MoveOn = 4,
    Flush = 8,
    Leave = 32
};

void seal(Bytes& transfer) {
    if (transfer.size() < kChunkHeaderBytes) return;
    const std::size_t head = get<std::uint16_t>(transfer, 6);
    if (head >= kChunkHeaderBytes && head <= transfer.size()) {
        const auto payload = std::span(transfer).subspan(head);
        put(std::span(transfer), 48, payload.empty() ? 0U : crc32c(payload));
    }
    put(std::span(transfer), 60, crc32c(std::span(transfer).first(60)));
}

ExpectedCapture expected(std::uint64_t id, int frames) {
    return {.bootId = 7,
            .captureId = id,
            .frames = frames,
            .frameBytes = 100,
            .maxChunkPayload = 40,
            .held = 2};
}

std::vector<std::string> soundTransfers() {
    std::string all;
    for (const std::uint64_t capture : {1U, 1U, 2U}) {
        Bytes pixels(100, 0x33);
        const Leader leader{.frameBytes = 100};
        const Trailer trailer{.frameBytes = 100, .frameCrc = crc32c(pixels)};
        ChunkHeader header{.type = ChunkType::Leader,
                           .bootId = 7,
                           .captureId = capture,
                           .frameIndex = static_cast<std::uint16_t>(all.empty() ? 0 : 1),
                           .chunkCount = 3};
        std::vector<Bytes> chunks{encodeChunk(header, encode(leader))};
        header.type = ChunkType::Data;
        for (std::uint32_t at = 0; at < 100; at += 40) {
            ++header.chunkIndex;
            header.offset = at;
            chunks.push_back(encodeChunk(
                header, std::span(pixels).subspan(at, std::min<std::size_t>(40, 100 - at))));
        }
        header = {.type = ChunkType::Trailer,
                  .bootId = 7,
                  .captureId = capture,
                  .frameIndex = header.frameIndex,
                  .chunkIndex = 4,
                  .chunkCount = 3};
        chunks.push_back(encodeChunk(header, encode(trailer)));
        for (const Bytes& chunk : chunks) {
            all += static_cast<char>(Seal | AskAgain);
            all += static_cast<char>(chunk.size() & 0xFFU);
            all += static_cast<char>(chunk.size() >> 8U);
            all += textOf(chunk);
        }
    }
    std::vector<std::string> seeds{all};
    for (const RecordedCall& call : calls()) {
        if (call.kind != RecordedCall::Kind::ReadBulk || call.got.empty()) continue;
        std::string one(1, 0);
        one += static_cast<char>(call.got.size() & 0xFFU);
        one += static_cast<char>(call.got.size() >> 8U & 0xFFU);
        seeds.push_back(one + textOf(call.got));
    }
    return seeds;
}

std::optional<Error> readTransfers(std::string_view text) {
    Bytes all = bytesOf(text);
    Assembler assembler;
    if (!assembler.expect(expected(1, 3)) || !assembler.expectNext(expected(2, 2)))
        return wrong("a small capture cannot be expected");
    std::span<const std::uint8_t> left = all;
    while (left.size() >= 3) {
        const std::uint8_t deed = left[0];
        const std::size_t length = std::min<std::size_t>(left[1] | left[2] << 8U, left.size() - 3);
        Bytes transfer(left.begin() + 3, left.begin() + 3 + static_cast<std::ptrdiff_t>(length));
        left = left.subspan(3 + length);
        if ((deed & Seal) != 0) seal(transfer);
        (void)decodeChunk(transfer);
        assembler.feed(transfer);
        for (const MissingChunks& lost : assembler.lost()) {
            if (lost.first > lost.last) return wrong("chunks are lost backwards");
            if ((deed & AskAgain) != 0) assembler.askedFor(lost);
        }
        while ((deed & Leave) == 0) {
            auto frame = assembler.take();
            if (!frame) break;
            if (frame->bytes.size() != 100 || crc32c(frame->bytes) != frame->trailer.frameCrc)
                return wrong("a frame that is none");
            assembler.giveBack(std::move(*frame));
        }
        if ((deed & MoveOn) != 0) {
            assembler.moveOn();
            if (!assembler.expectNext(expected(left.size(), 2))) return wrong("not expected");
        }
        if ((deed & Flush) != 0) assembler.flushed(static_cast<std::uint32_t>(left.size()));
    }
    return std::nullopt;
}

// ---- recordings

std::vector<std::string> soundRecordings() { return {recorded()}; }

/// With the CRC of each record put right, and of each report that the rig sends.
std::string resealed(std::string_view text) {
    Bytes bytes = bytesOf(text);
    const auto header = recordingHeader();
    if (bytes.size() < header.size()) return std::string(text);
    std::copy(header.begin(), header.end(), bytes.begin());
    for (std::size_t at = header.size(); at + 8 <= bytes.size();) {
        const std::size_t length = get<std::uint32_t>(bytes, at);
        if (length > bytes.size() - at - 8) break;
        const auto body = std::span(bytes).subspan(at + 4, length);
        if (length >= kReportBytes) {
            const auto last = body.last(kReportBytes);
            put(last, 62, crc16(last.first(62)));
        }
        put(std::span(bytes), at + 4 + length, crc32c(body));
        at += length + 8;
    }
    return textOf(bytes);
}

std::optional<Error> play(const std::string& bytes) {
    auto replay =
        Replay::open([&] { return std::make_unique<std::istringstream>(bytes); }, bytes.size());
    if (!replay) return replay.error();
    for (int openings = 0; openings < 4; ++openings) {
        const auto transport = (*replay)->openRig();
        if (!transport) {
            if (transport.error().kind == ErrorKind::NoRig) break;
            continue;
        }
        host(**transport, [](const Frame& frame) {
            if (frame.pixels.size() != kWindow.size) std::abort();
        });
    }
    return std::nullopt;
}

std::optional<Error> readRecording(std::string_view text) {
    (void)play(resealed(text));
    return play(std::string(text));
}

// ---- fault scripts

/// Those of the fault matrix.
std::vector<std::string> soundScripts() {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(GONIO_SOURCE_DIR "/tests/faults/scripts")) {
        std::ifstream in(entry.path());
        all.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return all;
}

std::optional<Error> readScript(std::string_view text) {
    const auto script = sim::FaultScript::parse(text);
    return script ? std::nullopt : std::optional(script.error());
}

constexpr std::array<Reader, 7> kReaders{
    {{"grp_reports", false, soundReports, readReports},
     {"grp_transfers", false, soundTransfers, readTransfers},
     {"usb_descriptors", false, soundDescriptors, readDescriptors},
     {"recording", false, soundRecordings, readRecording},
     {"fault_script", true, soundScripts, readScript},
     {"usbip_commands", false, soundConversations, readUsbipCommands},
     {"usbip_server", false, soundConversations, readUsbipConversation}}};

}  // namespace

std::span<const Reader> readers() { return kReaders; }

const Reader* readerOf(std::string_view name) {
    const auto found = std::find_if(
        kReaders.begin(), kReaders.end(), [&](const Reader& each) { return each.name == name; });
    return found == kReaders.end() ? nullptr : &*found;
}

}  // namespace gonio::test
