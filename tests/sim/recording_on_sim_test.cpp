// What passes between host and rig, recorded and played back: the same frames, anomalies and errors
// without a rig. Recordings that are cut off, damaged or hostile.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "driver/protocol/crc.h"
#include "driver/protocol/wire.h"
#include "driver/recorder.h"
#include "driver/replay.h"
#include "driver/rig.h"
#include "sim/in_process.h"

namespace gonio {
namespace {

using namespace driver;
namespace fs = std::filesystem;

constexpr std::uint64_t kSession = 0x1122334455667788;
constexpr Window kWindow{.x = 512, .y = 384, .size = {64, 64}, .binning = 1};

CaptureRequest dark(std::uint64_t planStep, int frames = 4) {
    return {.planStep = planStep,
            .led = std::nullopt,
            .levels = {},
            .exposure = Microseconds(320),
            .frames = frames};
}

/// Loses and damages transfers by a seed, and is gone after so many.
class BadCable : public Transport {
public:
    BadCable(Transport& inner, unsigned seed, int transfers)
        : inner_(inner), random_(seed), left_(transfers) {}
    [[nodiscard]] DeviceStrings strings() const override { return inner_.strings(); }
    [[nodiscard]] const Clock& clock() const override { return inner_.clock(); }
    Result<void> write(const Report& report) override {
        if (left_ < 0) return gone();
        return inner_.write(report);
    }
    Result<void> setFeature(const Report& report) override { return inner_.setFeature(report); }
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override {
        return inner_.getFeature(id);
    }
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override {
        return inner_.readInput(wait);
    }
    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override {
        auto transfer = inner_.readBulk(wait);
        if (!transfer || !*transfer) return transfer;
        if (--left_ < 0) return gone();
        const auto fate = random_() % 10;
        if (fate == 0) return std::optional<BulkBytes>{};
        if (fate > 1) return transfer;
        damaged_.assign((*transfer)->begin(), (*transfer)->end());
        damaged_[random_() % damaged_.size()] ^= 4;
        return std::optional<BulkBytes>(damaged_);
    }
    Result<void> reopenReports() override { return inner_.reopenReports(); }
    Result<void> resetPort() override { return inner_.resetPort(); }

private:
    static Error gone() { return {ErrorKind::Device, "the cable was pulled"}; }
    Transport& inner_;
    std::mt19937 random_;
    int left_;
    std::vector<std::uint8_t> damaged_;
};

/// What a host sees of its rig, as text and pixels.
struct Story {
    std::string text;
    std::vector<Image<std::uint16_t>> pictures;
    bool operator==(const Story&) const = default;
};

Story hostOf(Transport& transport, std::uint64_t session = kSession, std::uint64_t planStep = 1) {
    Story story;
    auto rig = Rig::open(transport, session);
    if (!rig) return {.text = rig.error().message, .pictures = {}};
    story.text = rig->identify().serial + "\n";
    if (auto set = rig->configure(kWindow); !set) story.text += set.error().message + "\n";
    for (std::uint64_t step = planStep; step < planStep + 4; ++step) {
        const ArmAhead ahead{.next = dark(step + 1)};
        const auto capture = rig->capture(dark(step), step % 2 == 1 ? ahead : ArmAhead{});
        if (!capture) {
            story.text += capture.error().message + "\n";
            continue;
        }
        for (const Frame& frame : *capture) story.pictures.push_back(frame.pixels);
        story.text += capture->anomalies.text() + ", " + std::to_string(capture->resends) +
                      " and " + std::to_string(capture->recaptures) + " again\n";
    }
    if (const auto events = rig->link().takeEvents())
        story.text += std::to_string(events->size()) + " events\n";
    return story;
}

class Recording : public testing::Test {
protected:
    Recording() { fs::remove(file_); }
    ~Recording() override { fs::remove(file_); }

    Story recorded(unsigned seed, int transfers = 1'000'000) {
        sim::InProcessDoor door({.serial = "SIM-0007", .seed = 3, .errors = {}});
        BadCable cable(door, seed, transfers);
        auto recorder = Recorder::open(file_);
        EXPECT_TRUE(recorder) << recorder.error().message;
        RecordingTransport transport(cable, **recorder);
        return hostOf(transport);
    }
    [[nodiscard]] std::string bytes() const {
        std::ifstream in(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    static Result<std::unique_ptr<Replay>> played(const std::string& bytes) {
        return Replay::open([&] { return std::make_unique<std::istringstream>(bytes); },
                            bytes.size());
    }

    fs::path file_ = fs::temp_directory_path() / ("gonio_recording_" + std::to_string(getpid()));
};

TEST_F(Recording, OfACaptureWithFaultsGivesTheSameFramesAnomaliesAndErrors) {
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
        SCOPED_TRACE(seed);
        fs::remove(file_);
        const Story seen = recorded(seed);
        EXPECT_NE(seen.text.find("lost chunk"), std::string::npos) << seen.text;
        auto replay = Replay::open(file_);
        ASSERT_TRUE(replay) << replay.error().message;
        EXPECT_FALSE((*replay)->session());
        auto transport = (*replay)->openRig();
        ASSERT_TRUE(transport);
        EXPECT_EQ((*replay)->session(), kSession);
        EXPECT_EQ((*replay)->nextPlanStep(), 1U);
        const Story again = hostOf(**transport);
        EXPECT_EQ(again.text, seen.text);
        EXPECT_EQ(again.pictures, seen.pictures);
        EXPECT_EQ((*replay)->nextPlanStep(), std::nullopt) << "all have been played";
    }
}

TEST_F(Recording, OfARigThatWentAwayEndsInTheSameErrors) {
    const Story seen = recorded(1, 40);
    EXPECT_NE(seen.text.find("the cable was pulled"), std::string::npos) << seen.text;
    auto replay = Replay::open(file_);
    ASSERT_TRUE(replay) << replay.error().message;
    EXPECT_EQ(hostOf(**(*replay)->openRig()), seen);
}

/// Opens the rig, and again each time it is lost, as long as `open` finds one and not for ever.
Story persistent(const std::function<Result<Transport*>()>& open) {
    Story story;
    int searches = 0;
    const auto search = [&](const Error& lost) -> Result<Transport*> {
        story.text += lost.message + "\n";
        ++searches;
        for (int i = 0; searches < 40 && i < 40; ++i) {
            if (auto found = open()) return found;
        }
        return Error{ErrorKind::Interrupted, "it did not come back"};
    };
    auto transport = open();
    if (!transport) return {.text = transport.error().message, .pictures = {}};
    auto rig = Rig::open(**transport, kSession);
    if (!rig) return {.text = rig.error().message, .pictures = {}};
    rig->onLost(search);
    if (auto set = rig->configure(kWindow); !set) story.text += set.error().message + "\n";
    for (std::uint64_t step = 1; step <= 8; ++step) {
        const auto capture = rig->capture(dark(step), {.next = dark(step + 1)});
        if (!capture) {
            story.text += capture.error().message + "\n";
            continue;
        }
        for (const Frame& frame : *capture) story.pictures.push_back(frame.pixels);
        story.text += capture->anomalies.text() + "\n";
    }
    for (const Interruption& gap : rig->takeInterruptions()) {
        story.text += gap.cause + ": " + std::to_string(gap.resent) + " resent, " +
                      std::to_string(gap.redone) + " redone\n";
    }
    rig->onLost({});
    return story;
}

TEST_F(Recording, OfEveryFaultOfTheMatrixGivesTheSameFramesAnomaliesAndErrors) {
    int scripts = 0, openings = 0;
    for (const auto& entry :
         fs::directory_iterator(fs::path(GONIO_SOURCE_DIR) / "tests/faults/scripts")) {
        SCOPED_TRACE(entry.path().filename().string());
        std::ifstream in(entry.path());
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        auto script = sim::FaultScript::parse(text);
        ASSERT_TRUE(script) << script.error().message;
        fs::remove(file_);
        Story seen;
        {
            sim::InProcessDoor first({.serial = "SIM-0007", .seed = 3, .errors = {}});
            auto recorder = Recorder::open(file_);
            ASSERT_TRUE(recorder);
            std::unique_ptr<sim::InProcessDoor> door;
            std::optional<RecordingTransport> transport;
            first.usb().play(*script);
            seen = persistent([&]() -> Result<Transport*> {
                transport.reset();
                door.reset();
                first.usb().advanceTo(first.usb().now() + std::chrono::milliseconds(250));
                auto opened = first.openAgain();
                if (!opened) {
                    recordRefusal(**recorder, opened.error(), first.usb().now());
                    return opened.error();
                }
                door = std::move(*opened);
                return &transport.emplace(*door, **recorder);
            });
        }
        auto replay = Replay::open(file_);
        ASSERT_TRUE(replay) << replay.error().message;
        std::unique_ptr<Transport> transport;
        const Story again = persistent([&]() -> Result<Transport*> {
            transport.reset();
            auto opened = (*replay)->openRig();
            if (!opened) return opened.error();
            ++openings;
            transport = std::move(*opened);
            return transport.get();
        });
        EXPECT_EQ(again.text, seen.text);
        EXPECT_EQ(again.pictures, seen.pictures);
        ++scripts;
    }
    EXPECT_GE(scripts, 20);
    EXPECT_GT(openings, scripts) << "some were lost and found again";
}

TEST_F(Recording, HoldsOneOpeningAfterTheOther) {
    const Story first = recorded(1, 40), second = recorded(2);
    {
        auto recorder = Recorder::open(file_);
        ASSERT_TRUE(recorder);
        for (int i = 0; i < 3; ++i)
            recordRefusal(**recorder, {ErrorKind::NoRig, "not there"}, Nanoseconds(5));
    }
    auto replay = Replay::open(file_);
    ASSERT_TRUE(replay) << replay.error().message;
    EXPECT_EQ((*replay)->serial(), "SIM-0007");
    EXPECT_EQ(hostOf(**(*replay)->openRig()), first);
    EXPECT_EQ(hostOf(**(*replay)->openRig()), second);
    EXPECT_EQ((*replay)->openRig().error().message, "not there") << "once for all three";
    const auto over = (*replay)->openRig();
    ASSERT_FALSE(over);
    EXPECT_EQ(over.error().kind, ErrorKind::NoRig);
}

TEST_F(Recording, SaysWhereTheHostDoesSomethingElse) {
    (void)recorded(1);
    auto replay = Replay::open(file_);
    ASSERT_TRUE(replay);
    auto transport = (*replay)->openRig();
    const Story other = hostOf(**transport, kSession, 9);
    EXPECT_NE(other.text.find("replay: record "), std::string::npos) << other.text;
    EXPECT_NE(other.text.find("wanted: write ARM, sequence 4; seen: write ARM, sequence 4; byte "
                              "11: wanted 01 00 00 00 00 00 04 00 .., seen 09 00 "),
              std::string::npos)
        << other.text;
    EXPECT_NE(other.text.find("; do the same jobs in the same order"), std::string::npos);
    EXPECT_TRUE(other.pictures.empty());
    const auto after = (*transport)->getFeature(1);
    ASSERT_FALSE(after);
    EXPECT_EQ(after.error().kind, ErrorKind::Device);
    ASSERT_TRUE((*replay)->end());
    EXPECT_EQ((*replay)->end()->message, after.error().message);
    EXPECT_EQ((*replay)->openRig().error().message, after.error().message);
}

TEST_F(Recording, SaysOfAnotherRequestWhatItIs) {
    (void)recorded(1);
    auto replay = Replay::open(file_);
    ASSERT_TRUE(replay);
    auto transport = (*replay)->openRig();
    const auto other = (*transport)->resetPort();
    ASSERT_FALSE(other);
    EXPECT_NE(other.error().message.find("wanted: get feature 01; seen: reset the port; do "),
              std::string::npos)
        << other.error().message;
}

TEST_F(Recording, OfTheFirstMomentsIsRefusedWhereverItIsCutOffOrDamaged) {
    {
        sim::InProcessDoor door({.errors = {}});
        auto recorder = Recorder::open(file_);
        ASSERT_TRUE(recorder);
        RecordingTransport transport(door, **recorder);
        (void)transport.getFeature(1);
        (void)transport.readInput(std::chrono::seconds(1));
        (void)transport.readBulk(Nanoseconds(0));
    }
    const std::string whole = bytes();
    ASSERT_TRUE(played(whole));
    int refused = 0;
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const auto cut = played(whole.substr(0, length));
        if (cut) continue;  // between two records
        EXPECT_EQ(cut.error().kind, ErrorKind::File);
        EXPECT_NE(cut.error().message.find("byte "), std::string::npos) << cut.error().message;
        ++refused;
    }
    EXPECT_EQ(static_cast<std::size_t>(refused), whole.size() - 5) << "5 records, the last whole";
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 16);
        EXPECT_FALSE(played(flipped)) << at;
    }
}

TEST_F(Recording, OfAHostileLengthIsRefusedByItsOffset) {
    const auto header = recordingHeader();
    std::string bytes(header.begin(), header.end());
    for (const char* length : {"\xFF\xFF\xFF\xFF", "\xFF\xFF\xFF\x03"}) {
        const auto refused = played(bytes + std::string(length, 4) + "abc");
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().message.find("byte 16, record 1"), std::string::npos)
            << refused.error().message;
    }
    std::vector<std::uint8_t> body(26 + 7, 0);
    body[0] = 3;  // a write of 7 bytes
    driver::put(std::span(body), 18, std::uint32_t{7});
    std::vector<std::uint8_t> record(4);
    driver::put(std::span(record), 0, static_cast<std::uint32_t>(body.size()));
    record.insert(record.end(), body.begin(), body.end());
    record.resize(record.size() + 4);
    driver::put(std::span(record), record.size() - 4, crc32c(body));
    const auto refused = played(bytes + std::string(record.begin(), record.end()));
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("makes no sense"), std::string::npos);
}

TEST_F(Recording, ThatIsNoneIsNotContinued) {
    std::ofstream(file_) << "a letter to a friend";
    const auto refused = Recorder::open(file_);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::File);
    EXPECT_EQ(bytes(), "a letter to a friend");
}

TEST_F(Recording, ThatAPowerCutHasTornIsContinuedAfterItsLastWholeRecord) {
    (void)recorded(1, 40);
    const std::string whole = bytes();
    const auto put = [&](const std::string& bytes) {
        std::ofstream(file_, std::ios::binary | std::ios::trunc) << bytes;
    };
    std::string blank = whole, damaged = whole;
    blank.append(5000, '\0');
    const std::string halfBlank = whole.substr(0, whole.size() - 10) + std::string(4096 + 10, '\0');
    damaged.back() = static_cast<char>(damaged.back() ^ 1);
    const std::size_t closing = 4 + 26 + 4;  // the last record is that of the close
    const std::string without = whole.substr(0, whole.size() - closing);
    const std::vector<std::pair<std::string, std::string>> torn{
        {whole.substr(0, whole.size() - 1), without},
        {without + whole.substr(without.size(), 3), without},
        {without + whole.substr(without.size(), 20), without},
        {damaged, without},
        {blank, whole},
        {halfBlank, without},
        {whole.substr(0, 9), whole.substr(0, kRecordingHeaderBytes)},
        {"", whole.substr(0, kRecordingHeaderBytes)}};
    for (const auto& [found, kept] : torn) {
        SCOPED_TRACE(found.size());
        put(found);
        const auto recorder = Recorder::open(file_);
        ASSERT_TRUE(recorder) << recorder.error().message;
        EXPECT_TRUE(bytes() == kept) << bytes().size() << " of " << kept.size();
        recordRefusal(**recorder, {ErrorKind::NoRig, "not there"}, Nanoseconds(5));
        EXPECT_TRUE(Replay::open(file_));
    }
}

TEST_F(Recording, ThatIsDamagedInTheMiddleIsNotContinuedAndKept) {
    (void)recorded(1, 40);
    std::string damaged = bytes();
    damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << damaged;
    EXPECT_FALSE(Recorder::open(file_));
    EXPECT_TRUE(bytes() == damaged);
}

TEST_F(Recording, WhoseFirstLengthIsDamagedIsNotTakenForATornOne) {
    while (bytes().size() < (std::size_t{1} << 20)) (void)recorded(1);
    std::string damaged = bytes();
    damaged[kRecordingHeaderBytes + 3] = 1;  // 16 MiB more
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << damaged;
    EXPECT_FALSE(Recorder::open(file_));
    EXPECT_TRUE(bytes() == damaged);
}

TEST_F(Recording, IsWrittenByOneAtATime) {
    {
        const auto first = Recorder::open(file_);
        ASSERT_TRUE(first) << first.error().message;
        const auto second = Recorder::open(file_);
        ASSERT_FALSE(second);
        EXPECT_EQ(second.error().kind, ErrorKind::Busy) << second.error().message;
    }
    EXPECT_TRUE(Recorder::open(file_)) << "given back";
}

TEST_F(Recording, EndsWhereTheDiskIsFullAndTheRunGoesOn) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{.rlim_cur = 60'000, .rlim_max = before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const Story seen = recorded(1);
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(seen.pictures.size(), 16U);
    EXPECT_LE(bytes().size(), 60'000U);
    EXPECT_GT(bytes().size(), 20'000U);
    auto replay = Replay::open(file_);
    ASSERT_TRUE(replay) << replay.error().message << ": only whole records are kept";
    const Story again = hostOf(**(*replay)->openRig());
    EXPECT_NE(again.text.find("here the recording of this opening ends"), std::string::npos);
}

}  // namespace
}  // namespace gonio
