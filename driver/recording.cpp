#include "driver/recording.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "driver/protocol/crc.h"
#include "driver/protocol/reports.h"
#include "driver/protocol/wire.h"

namespace gonio::driver {
namespace {

using Kind = RecordedCall::Kind;
using Outcome = RecordedCall::Outcome;
using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kMagic{'G', 'O', 'N', 'I', 'O', 'U', 'S', 'B'};
constexpr std::uint16_t kVersion = 1;
constexpr std::size_t kBodyHead = 26;  // kind, outcome, begin, end, lengths of sent and got
constexpr Nanoseconds kLatest{std::int64_t{1} << 60};  // 36 years after boot
constexpr std::size_t kShown = 8;                      // bytes of a report in a message

template <class T>
void append(std::vector<std::uint8_t>& bytes, T value) {
    bytes.resize(bytes.size() + sizeof value);
    put(std::span(bytes), bytes.size() - sizeof value, value);
}

void append(std::vector<std::uint8_t>& bytes, Bytes more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

void append(std::vector<std::uint8_t>& bytes, std::string_view text) {
    for (const char c : text) bytes.push_back(static_cast<std::uint8_t>(c));
}

/// " 20 88 77 .."
std::string hexOf(Bytes bytes) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    std::string text;
    for (const std::uint8_t byte : bytes.first(std::min(bytes.size(), kShown))) {
        text += ' ';
        text += kDigits[byte >> 4U];
        text += kDigits[byte & 15U];
    }
    return bytes.size() > kShown ? text + " .." : text;
}

std::string textOf(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

/// 8 was a call that nobody made.
bool isKind(std::uint8_t number) {
    return number >= static_cast<std::uint8_t>(Kind::Open) &&
           number <= static_cast<std::uint8_t>(Kind::ResetPort) && number != 8;
}

std::size_t sentBytes(Kind kind) {
    switch (kind) {
        case Kind::Write:
        case Kind::SetFeature: return kReportBytes;
        case Kind::GetFeature: return 1;
        default: return 0;
    }
}

bool gotFits(const RecordedCall& call) {
    switch (call.kind) {
        case Kind::Open: return decodeStrings(call.got).has_value();
        case Kind::GetFeature:
        case Kind::ReadInput: return call.got.size() == kReportBytes;
        case Kind::ReadBulk: return true;
        default: return call.got.empty();
    }
}

std::vector<std::uint8_t> encodeError(const Error& error) {
    std::vector<std::uint8_t> bytes;
    append(bytes, static_cast<std::uint8_t>(error.kind));
    append(bytes, static_cast<std::int32_t>(error.deviceStatus));
    append(bytes, std::string_view(error.message));
    return bytes;
}

std::optional<Error> decodeError(Bytes bytes) {
    constexpr std::size_t kHead = 5;
    if (bytes.size() < kHead || bytes[0] > static_cast<std::uint8_t>(ErrorKind::Interrupted))
        return std::nullopt;
    return Error{static_cast<ErrorKind>(bytes[0]),
                 textOf(bytes.subspan(kHead)),
                 get<std::int32_t>(bytes, 1)};
}

/// Empty: the body is of no call.
std::optional<RecordedCall> decodeBody(Bytes body) {
    if (body.size() < kBodyHead) return std::nullopt;
    const bool known = isKind(body[0]) && body[1] <= static_cast<std::uint8_t>(Outcome::Failed);
    const std::size_t sent = get<std::uint32_t>(body, 18), got = get<std::uint32_t>(body, 22);
    if (!known || sent + got != body.size() - kBodyHead) return std::nullopt;
    RecordedCall call{.kind = static_cast<Kind>(body[0]),
                      .outcome = static_cast<Outcome>(body[1]),
                      .begin = Nanoseconds(get<std::int64_t>(body, 2)),
                      .end = Nanoseconds(get<std::int64_t>(body, 10)),
                      .sent = {},
                      .got = {}};
    const Bytes answer = body.subspan(kBodyHead + sent);
    if (call.begin < Nanoseconds{0} || call.begin > call.end || call.end > kLatest)
        return std::nullopt;
    if (sent != sentBytes(call.kind)) return std::nullopt;
    call.sent.assign(body.begin() + kBodyHead, answer.begin());
    if (call.outcome == Outcome::Failed) {
        auto error = decodeError(answer);
        if (!error) return std::nullopt;
        call.error = std::move(*error);
        return call;
    }
    call.got.assign(answer.begin(), answer.end());
    const bool mayBeNothing = call.kind == Kind::ReadInput || call.kind == Kind::ReadBulk;
    const bool fits =
        call.outcome == Outcome::Nothing ? mayBeNothing && call.got.empty() : gotFits(call);
    if (!fits) return std::nullopt;
    return call;
}

}  // namespace

bool RecordedCall::ofHost() const { return kind != Kind::ReadInput && kind != Kind::ReadBulk; }

bool RecordedCall::operator==(const RecordedCall& other) const {
    return kind == other.kind && outcome == other.outcome && begin == other.begin &&
           end == other.end && sent == other.sent && got == other.got &&
           error.kind == other.error.kind && error.message == other.error.message &&
           error.deviceStatus == other.error.deviceStatus;
}

std::string describe(Kind kind, Bytes sent) {
    constexpr std::array<std::string_view, 11> kNames{"",
                                                      "open",
                                                      "close",
                                                      "write",
                                                      "set feature",
                                                      "get feature",
                                                      "read an input report",
                                                      "read the stream",
                                                      "",
                                                      "reopen the reports",
                                                      "reset the port"};
    const std::string text(kNames[static_cast<std::size_t>(kind)]);
    if (sent.empty()) return text;
    if (kind == Kind::Write && sent.size() == kReportBytes) {
        Report report{};
        std::copy(sent.begin(), sent.end(), report.begin());
        if (const Result<Command> command = decodeCommand(report))
            return text + " " + opName(command->op) + ", sequence " +
                   std::to_string(command->sequence);
    }
    return text + hexOf(kind == Kind::Write ? sent : sent.first(1));
}

std::string difference(const RecordedCall& wanted, Kind kind, Bytes sent) {
    const std::string text =
        "wanted: " + describe(wanted.kind, wanted.sent) + "; seen: " + describe(kind, sent);
    const Bytes then(wanted.sent);
    if (wanted.kind != kind || then.size() != sent.size()) return text;
    const auto [a, b] = std::mismatch(then.begin(), then.end(), sent.begin());
    if (a == then.end()) return text;
    const auto at = static_cast<std::size_t>(a - then.begin());
    return text + "; byte " + std::to_string(at) + ": wanted" + hexOf(then.subspan(at)) + ", seen" +
           hexOf(sent.subspan(at));
}

std::vector<std::uint8_t> encodeStrings(const DeviceStrings& strings) {
    std::vector<std::uint8_t> bytes;
    append(bytes, strings.vendor);
    append(bytes, strings.product);
    append(bytes, static_cast<std::uint16_t>(strings.serial.size()));
    append(bytes, std::string_view(strings.serial));
    append(bytes, std::string_view(strings.protocol));
    return bytes;
}

std::optional<DeviceStrings> decodeStrings(Bytes bytes) {
    constexpr std::size_t kHead = 6;
    if (bytes.size() < kHead) return std::nullopt;
    const std::size_t serial = get<std::uint16_t>(bytes, 4);
    const Bytes text = bytes.subspan(kHead);
    if (serial > text.size()) return std::nullopt;
    return DeviceStrings{.vendor = get<std::uint16_t>(bytes, 0),
                         .product = get<std::uint16_t>(bytes, 2),
                         .serial = textOf(text.first(serial)),
                         .protocol = textOf(text.subspan(serial))};
}

std::array<std::uint8_t, kRecordingHeaderBytes> recordingHeader() {
    std::array<std::uint8_t, kRecordingHeaderBytes> header{};
    std::copy(kMagic.begin(), kMagic.end(), header.begin());
    put(std::span<std::uint8_t>(header), 8, kVersion);
    put(std::span<std::uint8_t>(header), 12, crc32c(std::span(header).first(12)));
    return header;
}

void appendRecord(std::vector<std::uint8_t>& bytes, const RecordedCall& call) {
    const bool failed = call.outcome == Outcome::Failed;
    const auto error = failed ? encodeError(call.error) : std::vector<std::uint8_t>();
    const Bytes answer = failed ? Bytes(error) : Bytes(call.got);
    append(bytes, static_cast<std::uint32_t>(kBodyHead + call.sent.size() + answer.size()));
    const std::size_t body = bytes.size();
    append(bytes, static_cast<std::uint8_t>(call.kind));
    append(bytes, static_cast<std::uint8_t>(call.outcome));
    append(bytes, static_cast<std::int64_t>(call.begin.count()));
    append(bytes, static_cast<std::int64_t>(call.end.count()));
    append(bytes, static_cast<std::uint32_t>(call.sent.size()));
    append(bytes, static_cast<std::uint32_t>(answer.size()));
    append(bytes, Bytes(call.sent));
    append(bytes, answer);
    append(bytes, crc32c(Bytes(bytes).subspan(body)));
}

Result<RecordingReader> RecordingReader::open(std::unique_ptr<std::istream> file,
                                              std::uint64_t bytes) {
    RecordingReader reader(std::move(file), bytes);
    std::array<std::uint8_t, kRecordingHeaderBytes> header{};
    if (!reader.read(header) || !std::equal(kMagic.begin(), kMagic.end(), header.begin()))
        return reader.damaged(0, "this is no recording of a rig's traffic");
    if (get<std::uint32_t>(header, 12) != crc32c(std::span(header).first(12)))
        return reader.damaged(12, "the header's CRC does not agree");
    if (const auto version = get<std::uint16_t>(header, 8); version != kVersion) {
        return reader.damaged(
            8, "version " + std::to_string(version) + ", wanted " + std::to_string(kVersion));
    }
    return reader;
}

bool RecordingReader::read(std::span<std::uint8_t> into) {
    if (into.size() > bytes_ - at_) return false;
    file_->read(reinterpret_cast<char*>(into.data()),  // NOLINT(*reinterpret*): streams speak char
                static_cast<std::streamsize>(into.size()));
    at_ += into.size();
    return file_->gcount() == static_cast<std::streamsize>(into.size());
}

Error RecordingReader::damaged(std::uint64_t at, const std::string& what) const {
    return {ErrorKind::File,
            "recording: byte " + std::to_string(at) + ", record " + std::to_string(number_) + ": " +
                what};
}

Result<std::optional<RecordedCall>> RecordingReader::next() {
    const std::uint64_t begin = begin_ = at_;
    if (begin == bytes_) return std::optional<RecordedCall>{};
    std::array<std::uint8_t, 4> word{};
    const auto cut = [&] {
        return damaged(begin,
                       "cut off in the middle; shorten the file to " + std::to_string(begin) +
                           " bytes to replay what came before");
    };
    if (!read(word)) return cut();
    const std::size_t length = get<std::uint32_t>(word, 0);
    if (length > kLongestRecord)
        return damaged(begin, "a record of " + std::to_string(length) + " bytes cannot be");
    if (length + word.size() > bytes_ - at_) return cut();
    body_.resize(length);
    if (!read(body_) || !read(word)) return cut();
    if (get<std::uint32_t>(word, 0) != crc32c(body_))
        return damaged(begin, "the record's CRC does not agree");
    auto call = decodeBody(body_);
    if (!call) return damaged(begin, "the record makes no sense");
    ++number_;
    return call;
}

}  // namespace gonio::driver
