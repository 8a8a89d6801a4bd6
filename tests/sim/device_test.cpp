#include "sim/device.h"

#include <gtest/gtest.h>

#include <vector>

#include "driver/protocol/chunk.h"

namespace gonio::sim {
namespace {

using namespace driver;

constexpr std::uint64_t kSession = 0x1122334455667788;

/// The device's own answers: everything that waits in its input queue.
std::vector<Report> inputsOf(Device& device) {
    std::vector<Report> all;
    while (const auto report = device.takeInput()) all.push_back(*report);
    return all;
}

/// Sends a command; its ACK.
Ack answerTo(Device& device, Command command) {
    command.sessionLow = static_cast<std::uint32_t>(kSession);
    inputsOf(device);
    device.output(encode(command));
    for (const Report& report : inputsOf(device)) {
        if (const auto ack = decodeAck(report)) return *ack;
    }
    ADD_FAILURE() << "no ACK";
    return {};
}

SessionState sessionOf(Device& device) {
    return decodeSessionState(*device.getFeature(static_cast<std::uint8_t>(ReportId::Session)))
        .value();
}

void claim(Device& device, std::uint64_t id = kSession) {
    EXPECT_TRUE(device.setFeature(encode(SessionSet{.sessionId = id})));
}

TEST(Device, AnswersEveryFeatureOfTheTableAndStallsOnOthers) {
    Device device({});
    for (int id = 0; id < 256; ++id) {
        const auto report = device.getFeature(static_cast<std::uint8_t>(id));
        const bool known = (id >= 0x01 && id <= 0x06) || id == 0x10;
        EXPECT_EQ(report.has_value(), known) << id;
        if (!report) continue;
        EXPECT_EQ((*report)[0], id);
        EXPECT_TRUE(crcAgrees(*report));
    }
}

TEST(Device, BootIdDiffersFromBootToBoot) {
    const auto bootOf = [](DeviceConfig config) {
        Device device(std::move(config));
        return decodeIdent(*device.getFeature(static_cast<std::uint8_t>(ReportId::Ident)))->bootId;
    };
    EXPECT_EQ(bootOf({.bootCount = 1, .errors = {}}), bootOf({.bootCount = 1, .errors = {}}));
    EXPECT_NE(bootOf({.bootCount = 1, .errors = {}}), bootOf({.bootCount = 2, .errors = {}}));
}

TEST(Device, CommandsWithoutAClaimAreRefused) {
    Device device({});
    EXPECT_EQ(answerTo(device, {.sequence = 1}).status, status::kNotOwner);
    claim(device);
    EXPECT_EQ(answerTo(device, {.sequence = 1}).status, status::kOk);
}

TEST(Device, ARepeatedCommandIsAnsweredAgainAndDoneOnce) {
    Device device({});
    claim(device);
    const Command ping{.sequence = 1};
    const Ack first = answerTo(device, ping);
    device.advanceTo(device.now() + std::chrono::milliseconds(7));
    EXPECT_EQ(answerTo(device, ping), first);  // the time of then, not of now
    EXPECT_EQ(device.stats().replays, 1U);
    // The same number for something else, number 0, and one that is behind.
    EXPECT_EQ(answerTo(device, {.sequence = 1, .op = Op::Flush}).status, status::kBadSeq);
    EXPECT_EQ(answerTo(device, {.sequence = 0}).status, status::kBadSeq);
    EXPECT_EQ(answerTo(device, {.sequence = 65535}).status, status::kBadSeq);
    EXPECT_EQ(answerTo(device, {.sequence = 2}).status, status::kOk);
}

TEST(Device, ATornReportIsCountedAndNothingElse) {
    Device device({});
    claim(device);
    inputsOf(device);
    Report torn =
        encode(Command{.sessionLow = static_cast<std::uint32_t>(kSession), .sequence = 1});
    torn[20] ^= 1;
    device.output(torn);
    EXPECT_FALSE(device.takeInput());
    EXPECT_EQ(device.stats().crcRejects, 1U);
    Report claimTorn = encode(SessionSet{.sessionId = 99});
    claimTorn[20] ^= 1;
    EXPECT_TRUE(device.setFeature(claimTorn));  // no stall: it is told in the state
    EXPECT_EQ(sessionOf(device).statusOfLastSet, status::kBadCrc);
    EXPECT_EQ(sessionOf(device).sessionId, kSession);
}

TEST(Device, TheOwnerKeepsItsClaimUntilItGivesItBack) {
    Device device({});
    claim(device);
    claim(device, kSession + 1);
    EXPECT_EQ(sessionOf(device).statusOfLastSet, status::kBusy);
    device.setFeature(encode(SessionSet{.sessionId = kSession + 1, .release = true}));
    EXPECT_EQ(sessionOf(device).statusOfLastSet, status::kNotOwner);
    device.setFeature(encode(SessionSet{.sessionId = kSession, .release = true}));
    EXPECT_EQ(sessionOf(device).owner, Owner::None);
    claim(device, kSession + 1);
    EXPECT_EQ(sessionOf(device).sessionId, kSession + 1);
}

TEST(Device, ClaimsOutOfTheirDomainAreRefused) {
    for (const SessionSet& bad : {SessionSet{.sessionId = 0},
                                  SessionSet{.sessionId = 1ULL << 32},  // low half 0
                                  SessionSet{.sessionId = 1, .heartbeatMs = 499},
                                  SessionSet{.sessionId = 1, .heartbeatMs = 10001}}) {
        Device device({});
        EXPECT_TRUE(device.setFeature(encode(bad)));
        EXPECT_EQ(sessionOf(device).statusOfLastSet, status::kBadArg);
        EXPECT_EQ(sessionOf(device).owner, Owner::None);
    }
    for (const std::uint16_t edge : {std::uint16_t{500}, std::uint16_t{10000}}) {
        Device device({});
        device.setFeature(encode(SessionSet{.sessionId = 1, .heartbeatMs = edge}));
        EXPECT_EQ(sessionOf(device).owner, Owner::Alive);
    }
}

TEST(Device, TheHeartbeatLapsesAtItsTimeAndNotBefore) {
    Device device({});
    device.setFeature(encode(SessionSet{.sessionId = kSession, .heartbeatMs = 500}));
    device.advanceTo(std::chrono::milliseconds(500) - Nanoseconds(1));
    EXPECT_EQ(sessionOf(device).owner, Owner::Alive);
    device.advanceTo(std::chrono::milliseconds(500));
    EXPECT_EQ(sessionOf(device).owner, Owner::Lapsed);
    EXPECT_EQ(device.stats().lapses, 1U);
}

TEST(Device, TimeGoesToWhereItIsSentAndTheNextEventIsNeverBehind) {
    Device device({});
    for (int ms : {1, 99, 100, 101, 1000}) {
        device.advanceTo(std::chrono::milliseconds(ms));
        EXPECT_EQ(device.now(), std::chrono::milliseconds(ms));
        EXPECT_GE(device.nextEvent(), device.now());
    }
    device.advanceTo(Nanoseconds(0));
    EXPECT_EQ(device.now(), std::chrono::milliseconds(1000));  // never back
}

TEST(Device, EventsAreKeptForReadingAgain) {
    Device device({});
    claim(device);
    device.setInterlock(0);
    device.setInterlock(interlock::kMayLight);
    const auto page =
        decodeEventsPage(*device.getFeature(static_cast<std::uint8_t>(ReportId::Events)));
    ASSERT_TRUE(page);
    EXPECT_EQ(page->oldest, 1U);
    EXPECT_EQ(page->newest, 4U);
    ASSERT_EQ(page->events.size(), 2U);  // a page holds two
    EXPECT_EQ(page->events[0].code, event::kBoot);
    device.setFeature(encodeEventsFrom(3));
    const auto rest =
        decodeEventsPage(*device.getFeature(static_cast<std::uint8_t>(ReportId::Events)));
    ASSERT_EQ(rest->events.size(), 2U);
    EXPECT_EQ(rest->events[0].code, event::kInterlockOpened);
    EXPECT_EQ(rest->events[1].code, event::kInterlockClosed);
}

/// When the exposures of all waiting frames began, in microseconds since boot.
std::vector<std::uint64_t> startsOf(Device& device) {
    std::vector<std::uint64_t> starts;
    while (const auto chunk = device.takeBulk()) {
        const auto decoded = decodeChunk(*chunk);
        if (!decoded || decoded->header.type != ChunkType::Leader) continue;
        starts.push_back(decodeLeader(decoded->payload)->exposureStartUs);
    }
    return starts;
}

TEST(Device, AnLedThatTakesEffectAtTheEndOfACaptureSettlesBeforeTheNext) {
    Device device({});
    claim(device);
    std::uint16_t sequence = 0;
    const auto send = [&](Op op, const Arguments& arguments) {
        const Ack ack =
            answerTo(device, {.sequence = ++sequence, .op = op, .arguments = arguments});
        EXPECT_EQ(ack.status, status::kOk);
    };
    const auto light = [&](std::uint8_t led) {
        send(Op::SetLed, encode(SetLed{.led = led, .levels = {9, 0, 0}}));
    };
    send(Op::SetFormat, encode(SetFormat{.width = 8, .height = 8}));
    send(Op::SetExposure, encode(SetExposure{.exposureUs = 200'000}));
    light(1);
    send(Op::Arm, encode(Arm{.captureId = 1}));
    device.advanceTo(std::chrono::milliseconds(100));
    light(2);  // one is exposing: it waits for the frames to come
    device.advanceTo(std::chrono::milliseconds(206));
    send(Op::Arm, encode(Arm{.captureId = 2}));
    device.advanceTo(std::chrono::seconds(1));
    const auto starts = startsOf(device);
    ASSERT_EQ(starts.size(), 2U);
    EXPECT_NEAR(static_cast<double>(starts[0]), 5'000, 1);
    const double firstEnds = 5'000 + static_cast<double>(grantedExposure(200'000).count()) * 1e-3;
    EXPECT_NEAR(static_cast<double>(starts[1]), firstEnds + 5'000, 1);
}

TEST(Device, AResetStreamHoldsNothing) {
    Device device({});
    EXPECT_FALSE(device.takeBulk());
    device.resetStream();
    EXPECT_FALSE(device.takeBulk());
}

TEST(Device, TellsTheBitsOfItsPixelsAndWhatTheyMean) {
    for (const int bits : {8, 10, 12}) {
        Device device({.errors = {}, .rig = {.bits = bits}});
        const auto feature = [&](ReportId id) {
            return *device.getFeature(static_cast<std::uint8_t>(id));
        };
        const auto ident = decodeIdent(feature(ReportId::Ident));
        const auto limits = decodeLimits(feature(ReportId::Limits));
        ASSERT_TRUE(ident && limits);
        EXPECT_EQ(ident->bitDepth, bits);
        EXPECT_EQ(limits->blackLevel, digitsOf(bits).blackLevel);
        EXPECT_EQ(limits->fullScale, (1 << bits) - 1);
    }
}

TEST(Device, ACommandThatIsRefusedAsBusyIsDoneWhenItComesAgain) {
    Device device({.errors = {}});
    claim(device);
    const SetFormat small{.format = PixelFormat::Mono16, .width = 16, .height = 8, .binning = 1};
    answerTo(device, {.sequence = 1, .op = Op::SetFormat, .arguments = encode(small)});
    answerTo(device,
             {.sequence = 2, .op = Op::Arm, .arguments = encode(Arm{.captureId = 1, .frames = 1})});
    device.advanceTo(device.now() + std::chrono::seconds(1));
    Command again{
        .sequence = 3, .op = Op::Resend, .arguments = encode(Resend{.captureId = 1, .frame = 0})};
    Ack ack = answerTo(device, again);
    for (; ack.status == status::kOk && again.sequence < 100; ack = answerTo(device, again))
        ++again.sequence;
    EXPECT_EQ(ack.status, status::kBusy);
    EXPECT_GT(ack.retryMs, 0);
    while (device.takeBulk()) {
    }
    EXPECT_EQ(answerTo(device, again).status, status::kOk);
}

TEST(Device, OnChangeStatusComesOnceIn10MsAtMost) {
    constexpr auto kPause = std::chrono::milliseconds(10);
    Device device({.errors = {}});
    claim(device);
    device.advanceTo(device.now() + kPause);
    inputsOf(device);
    std::vector<Nanoseconds> told;
    const Nanoseconds begin = device.now();
    for (std::uint16_t sequence = 1; sequence <= 5; ++sequence) {
        device.output(encode(Command{.sessionLow = static_cast<std::uint32_t>(kSession),
                                     .sequence = sequence,
                                     .op = Op::Abort}));
        device.advanceTo(device.now() + std::chrono::microseconds(100));
        for (const Report& report : inputsOf(device))
            if (decodeStatus(report)) told.push_back(device.now());
    }
    EXPECT_LE(told.size(), 1U);
    device.advanceTo(begin + 3 * kPause);
    std::size_t later = 0;
    for (const Report& report : inputsOf(device)) later += decodeStatus(report) ? 1U : 0U;
    EXPECT_EQ(later, 1U) << "the last change is told all the same";
}

}  // namespace
}  // namespace gonio::sim
