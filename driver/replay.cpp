#include "driver/replay.h"

#include <algorithm>
#include <deque>
#include <fstream>
#include <system_error>
#include <utility>

#include "driver/capture_ids.h"
#include "driver/protocol/reports.h"

namespace gonio::driver {
namespace {

using Kind = RecordedCall::Kind;
using Outcome = RecordedCall::Outcome;
using Bytes = std::vector<std::uint8_t>;

Report reportOf(const Bytes& bytes) {
    Report report{};
    std::copy_n(bytes.begin(), std::min(bytes.size(), report.size()), report.begin());
    return report;
}

constexpr const char* kCure =
    "; do the same jobs in the same order, on the same calibrations (docs/recording.md)";

std::optional<std::uint64_t> sessionIn(const RecordedCall& call) {
    if (call.kind != Kind::SetFeature ||
        call.sent.front() != static_cast<std::uint8_t>(ReportId::Session))
        return std::nullopt;
    const Result<SessionSet> set = decodeSessionSet(reportOf(call.sent));
    return set ? std::optional(set->sessionId) : std::nullopt;
}

}  // namespace

class Replay::PlayedTransport : public Transport, private Clock {
public:
    PlayedTransport(Replay& replay, DeviceStrings strings, Nanoseconds now)
        : replay_(replay), strings_(std::move(strings)), now_(now) {}

    [[nodiscard]] DeviceStrings strings() const override { return strings_; }
    [[nodiscard]] const Clock& clock() const override { return *this; }

    Result<void> write(const Report& report) override { return plain(Kind::Write, report); }
    Result<void> setFeature(const Report& report) override {
        return plain(Kind::SetFeature, report);
    }
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override {
        const Result<Bytes> got = ask(Kind::GetFeature, BulkBytes(&id, 1));
        if (!got) return got.error();
        return reportOf(*got);
    }
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override {
        const Result<std::optional<Bytes>> got = read(Kind::ReadInput, wait);
        if (!got) return got.error();
        return *got ? std::optional(reportOf(**got)) : std::nullopt;
    }
    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override {
        Result<std::optional<Bytes>> got = read(Kind::ReadBulk, wait);
        if (!got) return got.error();
        if (!*got) return std::optional<BulkBytes>{};
        lent_ = std::move(**got);
        return std::optional<BulkBytes>(lent_);
    }
    Result<void> reopenReports() override { return plain(Kind::ReopenReports, {}); }
    Result<void> resetPort() override { return plain(Kind::ResetPort, {}); }

private:
    [[nodiscard]] Nanoseconds now() const override { return now_; }

    Result<void> plain(Kind kind, BulkBytes sent) {
        const Result<Bytes> done = ask(kind, sent);
        if (!done) return done.error();
        return {};
    }
    Result<Bytes> ask(Kind kind, BulkBytes sent);
    Result<std::optional<Bytes>> read(Kind kind, Nanoseconds wait);
    /// The next record of this opening; null, and a failure, at its end.
    [[nodiscard]] const RecordedCall* next(Kind kind, BulkBytes sent);
    Result<RecordedCall> take();
    void set(Nanoseconds now) { now_ = std::max(now_, now); }
    std::deque<Bytes>& waiting(Kind kind) { return kind == Kind::ReadBulk ? bulk_ : inputs_; }
    Error fail(const std::string& what) {
        failure_ =
            Error{ErrorKind::Device, "replay: record " + std::to_string(replay_.number_) + what};
        return *failure_;
    }

    Replay& replay_;
    DeviceStrings strings_;
    Nanoseconds now_;
    std::deque<Bytes> inputs_, bulk_;  ///< came before the host read them
    Bytes lent_;
    std::optional<Error> failure_;
};

const RecordedCall* Replay::PlayedTransport::next(Kind kind, BulkBytes sent) {
    if (failure_) return nullptr;
    const RecordedCall* call = replay_.ahead();
    if (call && call->kind != Kind::Open) return call;
    (void)fail(": here the recording of this opening ends; seen: " + describe(kind, sent));
    return nullptr;
}

Result<RecordedCall> Replay::PlayedTransport::take() {
    RecordedCall call = std::move(*replay_.ahead_);
    set(call.end);
    if (auto on = replay_.advance(); !on) {
        failure_ = on.error();
        return *failure_;
    }
    return call;
}

Result<Bytes> Replay::PlayedTransport::ask(Kind kind, BulkBytes sent) {
    while (const RecordedCall* call = next(kind, sent)) {
        if (call->ofHost()) {
            if (call->kind != kind || !std::equal(sent.begin(), sent.end(), call->sent.begin())) {
                replay_.diverged_ = fail(": " + difference(*call, kind, sent) + kCure);
                return *failure_;
            }
            Result<RecordedCall> taken = take();
            if (!taken) return taken.error();
            if (taken->outcome == Outcome::Failed) return taken->error;
            return std::move(taken->got);
        }
        Result<RecordedCall> taken = take();
        if (!taken) return taken.error();
        if (taken->outcome == Outcome::Done) waiting(taken->kind).push_back(std::move(taken->got));
    }
    return *failure_;
}

Result<std::optional<Bytes>> Replay::PlayedTransport::read(Kind kind, Nanoseconds wait) {
    if (auto& queue = waiting(kind); !failure_ && !queue.empty()) {
        std::optional<Bytes> first = std::move(queue.front());
        queue.pop_front();
        return first;
    }
    while (const RecordedCall* call = next(kind, {})) {
        if (call->ofHost()) {
            now_ = now_ < call->begin ? call->begin : now_ + std::max(wait, Nanoseconds{0});
            return std::optional<Bytes>{};
        }
        Result<RecordedCall> taken = take();
        if (!taken) return taken.error();
        if (taken->outcome == Outcome::Failed) return taken->error;
        const bool come = taken->outcome == Outcome::Done;
        if (taken->kind == kind)
            return come ? std::optional(std::move(taken->got)) : std::optional<Bytes>{};
        if (come) waiting(taken->kind).push_back(std::move(taken->got));
    }
    return *failure_;
}

Result<std::unique_ptr<Replay>> Replay::open(const std::filesystem::path& file) {
    std::error_code problem;
    const std::uint64_t bytes = std::filesystem::file_size(file, problem);
    if (problem)
        return Error{ErrorKind::File, "replay " + file.string() + ": " + problem.message()};
    auto replay =
        open([&] { return std::make_unique<std::ifstream>(file, std::ios::binary); }, bytes);
    if (!replay) return replay.error().in("replay " + file.string());
    return replay;
}

Result<std::unique_ptr<Replay>> Replay::open(
    const std::function<std::unique_ptr<std::istream>()>& source, std::uint64_t bytes) {
    auto first = RecordingReader::open(source(), bytes);
    if (!first) return first.error();
    auto second = RecordingReader::open(source(), bytes);
    if (!second) return second.error();
    std::unique_ptr<Replay> replay(new Replay(std::move(*second)));
    if (auto sound = replay->readThrough(std::move(*first)); !sound) return sound.error();
    if (auto begun = replay->advance(); !begun) return begun.error();
    return replay;
}

/// Whatever is wrong is found before anything is played.
Result<void> Replay::readThrough(RecordingReader reader) {
    while (true) {
        const std::uint64_t number = reader.number();
        const auto call = reader.next();
        if (!call) return call.error();
        if (!*call) return {};
        notePlanStep(**call, number);
        if ((*call)->kind == Kind::Open && (*call)->outcome == Outcome::Done) {
            sessions_.emplace_back();
            if (serial_.empty()) serial_ = decodeStrings((*call)->got)->serial;
        } else if (!sessions_.empty() && !sessions_.back()) {
            sessions_.back() = sessionIn(**call);
        }
    }
}

void Replay::notePlanStep(const RecordedCall& call, std::uint64_t number) {
    if (call.kind != Kind::Write) return;
    const Result<Command> command = decodeCommand(reportOf(call.sent));
    if (!command || command->op != Op::Arm) return;
    arms_.push_back({number, CaptureIds::planStepOf(decodeArm(command->arguments).captureId)});
}

Result<void> Replay::advance() {
    number_ = reader_.number();
    auto call = reader_.next();
    if (!call) {
        ahead_.reset();
        return call.error();
    }
    ahead_ = std::move(*call);
    return {};
}

std::optional<Error> Replay::end() const {
    if (diverged_) return diverged_;
    if (!ahead_) return Error{ErrorKind::NoRig, "replay: the recording is over"};
    return std::nullopt;
}

Result<std::unique_ptr<Transport>> Replay::openRig() {
    if (diverged_) return *diverged_;
    while (ahead_ && ahead_->kind != Kind::Open) {
        if (auto on = advance(); !on) return on.error();
    }
    if (const auto over = end()) return *over;
    const RecordedCall opening = std::move(*ahead_);
    if (auto on = advance(); !on) return on.error();
    if (opening.outcome == Outcome::Failed) return opening.error;
    ++opened_;
    return std::unique_ptr<Transport>(
        std::make_unique<PlayedTransport>(*this, *decodeStrings(opening.got), opening.end));
}

std::optional<std::uint64_t> Replay::session() const {
    return opened_ > 0 ? sessions_[opened_ - 1] : std::nullopt;
}

std::optional<std::uint64_t> Replay::nextPlanStep() const {
    const auto next = std::lower_bound(
        arms_.begin(), arms_.end(), number_, [](const ArmedStep& arm, std::uint64_t number) {
            return arm.number < number;
        });
    return next != arms_.end() ? std::optional(next->planStep) : std::nullopt;
}

}  // namespace gonio::driver
