#include "driver/recorder.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <system_error>
#include <type_traits>
#include <utility>

#include "driver/protocol/wire.h"
#include "proc/core/log.h"

namespace gonio::driver {
namespace {

namespace fs = std::filesystem;
using Kind = RecordedCall::Kind;
using Outcome = RecordedCall::Outcome;

Error fileError(const fs::path& path, const std::string& what) {
    return {ErrorKind::File, "record to " + path.string() + ": " + what};
}

/// Nothing, or the beginning of a header: whoever began it was stopped at once.
bool hardlyBegun(std::istream& file, std::uint64_t bytes) {
    if (bytes >= kRecordingHeaderBytes) return false;
    const auto header = recordingHeader();
    std::string begun(bytes, '\0');
    file.read(begun.data(), static_cast<std::streamsize>(bytes));
    return file && std::equal(begun.begin(), begun.end(), header.begin(), [](char a, auto b) {
               return static_cast<std::uint8_t>(a) == b;
           });
}

bool allZeroFrom(std::istream& file, std::uint64_t begin) {
    file.seekg(static_cast<std::streamoff>(begin));
    return std::all_of(std::istreambuf_iterator<char>(file), {}, [](char c) { return c == 0; });
}

/// From `begin` on there is one record at most, of which not all reached the disk: it is cut off,
/// damaged and the last, or zeros are in its place or behind it. One that claims more than is left
/// is cut off only where no more is left than a record may have, `longest`: else its length is
/// what is damaged, and sound records follow.
bool tornFrom(std::istream& file, std::uint64_t begin, std::uint64_t bytes, std::uint64_t longest) {
    std::array<std::uint8_t, 4> word{};
    const std::uint64_t frame = 2 * word.size();  // a length before, a CRC after
    const std::uint64_t left = bytes - begin;
    if (left < frame) return true;
    file.seekg(static_cast<std::streamoff>(begin));
    file.read(reinterpret_cast<char*>(word.data()), word.size());  // NOLINT(*reinterpret*)
    const auto length = get<std::uint32_t>(word, 0);
    if (length == 0) return allZeroFrom(file, begin);
    if (length + frame >= left) return length <= kLongestRecord && left <= longest;
    return allZeroFrom(file, begin + length + frame);
}

/// Of a recording, in bytes: what it has, and how much of that can be continued.
struct Extent {
    std::uint64_t all = 0, sound = 0;
};

/// Or why nothing can be continued.
Result<Extent> extentOf(const fs::path& path) {
    constexpr std::uint64_t kUsualRecord = std::uint64_t{1} << 19;  // a chunk of 256 KiB
    std::error_code problem;
    const std::uint64_t bytes = fs::file_size(path, problem);
    if (problem) return fileError(path, problem.message());
    std::ifstream file(path, std::ios::binary);
    if (hardlyBegun(file, bytes)) return Extent{.all = bytes, .sound = 0};
    auto reader =
        RecordingReader::open(std::make_unique<std::ifstream>(path, std::ios::binary), bytes);
    if (!reader) return reader.error().in(path.string());
    std::uint64_t longest = kUsualRecord;
    while (true) {
        const std::uint64_t before = reader->begin();
        const auto call = reader->next();
        longest = std::max(longest, reader->begin() - before);
        if (!call && tornFrom(file, reader->begin(), bytes, longest))
            return Extent{.all = bytes, .sound = reader->begin()};
        if (!call) return call.error().in(path.string());
        if (!*call) return Extent{.all = bytes, .sound = bytes};
    }
}

/// Without the record that the last writer was stopped in.
Result<void> shorten(const fs::path& path, const Extent& extent) {
    if (extent.sound == extent.all) return {};
    std::error_code problem;
    fs::resize_file(path, extent.sound, problem);
    if (problem) return fileError(path, "its torn last record: " + problem.message());
    log::warning(
        "record to " + path.string() + ": the last " + std::to_string(extent.all - extent.sound) +
        " bytes were torn and are cut off; it goes on at byte " + std::to_string(extent.sound));
    return {};
}

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::open(const fs::path& file) {
    auto lock = FileLock::take(
        file,
        0666,
        "record to " + file.string() + ": another program writes it; end that, or name another");
    if (!lock && lock.error().kind == ErrorKind::Busy) return lock.error();
    if (!lock) return Error{lock.error().kind, "record to " + lock.error().message};
    std::unique_ptr<Recorder> recorder(new Recorder(file, std::move(*lock)));
    const Result<Extent> extent = extentOf(file);
    if (!extent) return extent.error();
    if (Result<void> cut = shorten(file, *extent); !cut) return cut.error();
    recorder->bytes_ = extent->sound;
    // Without a buffer of its own: what has been written is there whatever becomes of the program.
    recorder->file_.rdbuf()->pubsetbuf(nullptr, 0);
    recorder->file_.open(file, std::ios::binary | std::ios::app);
    if (!recorder->file_) return fileError(file, std::strerror(errno));
    if (recorder->bytes_ > 0) return recorder;
    const auto header = recordingHeader();
    recorder->buffer_.assign(header.begin(), header.end());
    if (!recorder->write()) return fileError(file, std::strerror(errno));
    return recorder;
}

bool Recorder::write() {
    file_.write(reinterpret_cast<const char*>(buffer_.data()),  // NOLINT(*reinterpret*)
                static_cast<std::streamsize>(buffer_.size()));
    if (!file_) return false;
    bytes_ += buffer_.size();
    return true;
}

void Recorder::add(const RecordedCall& call) {
    if (ended()) return;
    const bool refused = call.kind == Kind::Open && call.outcome == Outcome::Failed;
    if (refused && call.error.message == refusal_) return;
    refusal_ = refused ? call.error.message : "";
    buffer_.clear();
    appendRecord(buffer_, call);
    if (write()) return;
    const std::string why = std::strerror(errno);
    file_.close();
    std::error_code ignored;
    fs::resize_file(path_, bytes_, ignored);  // without the half of this record
    ending_ = "record to " + path_.string() + ": " + why + "; the record ends here at " +
              std::to_string(bytes_) + " bytes, the rig goes on";
    log::warning(ending_);
}

RecordingTransport::RecordingTransport(Transport& inner, Recorder& recorder)
    : inner_(inner), recorder_(recorder) {
    call_.got = encodeStrings(inner_.strings());
    call_.begin = call_.end = clock().now();
    recorder_.add(call_);
}

void RecordingTransport::note(const Report& report) {
    call_.got.assign(report.begin(), report.end());
}

template <class Bytes>
void RecordingTransport::note(const std::optional<Bytes>& come) {
    call_.outcome = come ? Outcome::Done : Outcome::Nothing;
    if (come) call_.got.assign(come->begin(), come->end());
}

template <class Ask>
auto RecordingTransport::recorded(Kind kind, BulkBytes sent, Ask ask) {
    call_.kind = kind;
    call_.outcome = Outcome::Done;
    call_.sent.assign(sent.begin(), sent.end());
    call_.got.clear();
    call_.begin = clock().now();
    auto answer = ask();
    call_.end = clock().now();
    if (!answer) {
        call_.outcome = Outcome::Failed;
        call_.error = answer.error();
    } else if constexpr (!std::is_same_v<decltype(answer), Result<void>>) {
        note(*answer);
    }
    recorder_.add(call_);
    return answer;
}

RecordingTransport::~RecordingTransport() {
    (void)recorded(Kind::Close, {}, [] { return Result<void>(); });
}

Result<void> RecordingTransport::write(const Report& report) {
    return recorded(Kind::Write, report, [&] { return inner_.write(report); });
}

Result<void> RecordingTransport::setFeature(const Report& report) {
    return recorded(Kind::SetFeature, report, [&] { return inner_.setFeature(report); });
}

Result<Report> RecordingTransport::getFeature(std::uint8_t id) {
    return recorded(Kind::GetFeature, BulkBytes(&id, 1), [&] { return inner_.getFeature(id); });
}

Result<std::optional<Report>> RecordingTransport::readInput(Nanoseconds wait) {
    return recorded(Kind::ReadInput, {}, [&] { return inner_.readInput(wait); });
}

Result<std::optional<BulkBytes>> RecordingTransport::readBulk(Nanoseconds wait) {
    return recorded(Kind::ReadBulk, {}, [&] { return inner_.readBulk(wait); });
}

Result<void> RecordingTransport::reopenReports() {
    return recorded(Kind::ReopenReports, {}, [&] { return inner_.reopenReports(); });
}

Result<void> RecordingTransport::resetPort() {
    return recorded(Kind::ResetPort, {}, [&] { return inner_.resetPort(); });
}

void recordRefusal(Recorder& recorder, const Error& error, Nanoseconds at) {
    RecordedCall call{.kind = Kind::Open, .outcome = Outcome::Failed, .begin = at, .end = at};
    call.error = error;
    recorder.add(call);
}

}  // namespace gonio::driver
