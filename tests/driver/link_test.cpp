#include "driver/link.h"

#include <gtest/gtest.h>

#include "tests/driver/scripted_rig.h"

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;
using test::ScriptedRig;

constexpr std::uint64_t kSession = 0x1122334455667788;

std::unique_ptr<RigLink> opened(ScriptedRig& rig) {
    auto link = RigLink::open(rig, {.sessionId = kSession});
    EXPECT_TRUE(link) << link.error().message;
    return std::move(*link);
}

Error refusal(ScriptedRig& rig, const LinkOptions& options = {.sessionId = kSession}) {
    const auto link = RigLink::open(rig, options);
    EXPECT_FALSE(link);
    return link ? Error{} : link.error();
}

bool mentions(const Error& error, const std::string& text) {
    return error.message.find(text) != std::string::npos;
}

TEST(RigLink, ClaimsAndGivesBack) {
    ScriptedRig rig;
    {
        const auto link = opened(rig);
        EXPECT_EQ(rig.session.sessionId, kSession);
        EXPECT_EQ(link->ident(), rig.ident);
        EXPECT_EQ(link->limits(), rig.limits);
        EXPECT_FALSE(link->resumed());
    }
    EXPECT_EQ(rig.session.owner, Owner::None);
}

TEST(RigLink, RefusesAnotherMajorAndSaysBoth) {
    ScriptedRig rig;
    rig.identity.protocol = "GRP/2.3";
    const Error error = refusal(rig);
    EXPECT_TRUE(mentions(error, "GRP/2.3")) << error.message;
    EXPECT_TRUE(mentions(error, "GRP/1.0")) << error.message;
    EXPECT_EQ(rig.session.owner, Owner::None) << "identified only, never claimed";
    rig.identity.protocol = "GRP/1.0";
    rig.ident.major = 2;
    EXPECT_TRUE(mentions(refusal(rig), "GRP/2.0"));
}

TEST(RigLink, AcceptsANewerMinor) {
    ScriptedRig rig;
    rig.identity.protocol = "GRP/1.7";
    rig.ident.minor = 7;
    EXPECT_TRUE(RigLink::open(rig, {.sessionId = kSession}));
}

TEST(RigLink, RefusesWhatIsNoVersion) {
    for (const char* text :
         {"", "GRP", "GRP/", "GRP/1", "GRP/1.", "GRP/x.0", "GRP/1.0 ", "XYZ/1.0", "GRP/1.-1"}) {
        ScriptedRig rig;
        rig.identity.protocol = text;
        EXPECT_EQ(refusal(rig).kind, ErrorKind::Device) << text;
    }
}

TEST(RigLink, RefusesImpossibleIdentAndLimits) {
    const auto refused = [](auto change) {
        ScriptedRig rig;
        change(rig);
        return mentions(refusal(rig), "cannot be");
    };
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.ledCount = 0; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.ledCount = 9; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.sensorWidth = 0; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.sensorHeight = 0; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.bitDepth = 17; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.maxChunkPayload = 0; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.maxChunkPayload = 0xFFFFFFFF; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.exposureMinUs = 2000000; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.controlLatency = 0; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.limits.maxFrames = 0; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.limits.roiStep = 0; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.limits.framePeriodUs = 0xFFFFFFFF; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.limits.fullScale = 60; }));
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.limits.fullScale = 4096; })) << "of 12 bits";
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.limits.formats = 4; })) << "none that we know";
    EXPECT_TRUE(refused([](ScriptedRig& r) { r.ident.sensorWidth = r.ident.sensorHeight = 65535; }))
        << "its frame_bytes have no room on the wire";
}

TEST(RigLink, RefusesHostileStringsAndSaysThemWithoutHarm) {
    for (const std::string& serial : {std::string(),
                                      std::string(33, 'A'),
                                      std::string("\x1B[2J"),
                                      std::string("A\0B", 3),
                                      std::string("A B"),
                                      std::string("\xFF")}) {
        ScriptedRig rig;
        rig.identity.serial = serial;
        const Error error = refusal(rig);
        EXPECT_TRUE(mentions(error, "serial number")) << error.message;
        EXPECT_LT(error.message.size(), 130U);
        for (const char c : error.message) EXPECT_TRUE(c >= ' ' && c <= '~') << serial;
    }
    ScriptedRig rig;
    rig.identity.protocol = "\x1B]0;hello\x07" + std::string(10000, 'x');
    const Error error = refusal(rig);
    EXPECT_TRUE(mentions(error, "not a gonio rig"));
    EXPECT_LT(error.message.size(), 200U);
    EXPECT_EQ(error.message.find('\x1B'), std::string::npos);
}

TEST(RigLink, RefusesOptionsOutOfTheirDomain) {
    ScriptedRig rig;
    EXPECT_EQ(refusal(rig, {.sessionId = 0x100000000}).kind, ErrorKind::Usage);
    EXPECT_EQ(refusal(rig, {.sessionId = 1, .heartbeatMs = 499}).kind, ErrorKind::Usage);
    EXPECT_EQ(refusal(rig, {.sessionId = 1, .heartbeatMs = 10001}).kind, ErrorKind::Usage);
    EXPECT_TRUE(RigLink::open(rig, {.sessionId = 1, .heartbeatMs = 500}));
    EXPECT_TRUE(RigLink::open(rig, {.sessionId = 1, .heartbeatMs = 10000}));
}

TEST(RigLink, IsBusyWhenAnotherOwnsTheRig) {
    ScriptedRig rig;
    rig.session = {.sessionId = 99, .owner = Owner::Alive};
    EXPECT_EQ(refusal(rig).kind, ErrorKind::Busy);
    EXPECT_EQ(rig.session.sessionId, 99U);
}

TEST(RigLink, WaitsForARigThatBootsButNotForEver) {
    ScriptedRig rig;
    rig.bootingClaims = 3;
    EXPECT_TRUE(RigLink::open(rig, {.sessionId = kSession}));
    ScriptedRig stuck;
    stuck.bootingClaims = 1000;
    EXPECT_EQ(refusal(stuck).deviceStatus, status::kBusy);
    EXPECT_LE(stuck.clock().now(), 4s);
}

TEST(RigLink, ContinuesTheNumbersOfItsOwnClaim) {
    ScriptedRig rig;
    rig.session = {.sessionId = kSession, .lastCommand = 41, .owner = Owner::Alive};
    const auto link = opened(rig);
    EXPECT_TRUE(link->resumed());
    ASSERT_TRUE(link->command(Op::Ping));
    EXPECT_EQ(rig.log.back().sequence, 42);
}

TEST(RigLink, CommandNumbersWrapPastZero) {
    ScriptedRig rig;
    rig.session = {.sessionId = kSession, .lastCommand = 65534, .owner = Owner::Alive};
    const auto link = opened(rig);
    ASSERT_TRUE(link->command(Op::Ping));
    EXPECT_EQ(rig.log.back().sequence, 65535);
    ASSERT_TRUE(link->command(Op::Ping));
    EXPECT_EQ(rig.log.back().sequence, 1);
}

TEST(RigLink, LostAckIsReadAgain) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.loseAcks = 1;
    EXPECT_TRUE(link->command(Op::Flush));
    EXPECT_EQ(rig.log.size(), 1U) << "LAST_ACK had it, nothing was repeated";
}

TEST(RigLink, LostCommandIsRepeatedWithTheSameBytes) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.loseCommands = 2;
    EXPECT_TRUE(link->command(Op::SetLed, encode(SetLed{.led = 1, .levels = {5, 0, 0}})));
    ASSERT_EQ(rig.log.size(), 3U);
    EXPECT_EQ(rig.log[0], rig.log[2]);
    EXPECT_EQ(rig.done, 1);
    EXPECT_EQ(link->counters().repeats, 2U);
}

TEST(RigLink, RepeatedCommandActsOnce) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.loseAcks = 1;
    rig.noLastAck = true;
    EXPECT_TRUE(link->command(Op::Flush));
    EXPECT_EQ(rig.log.size(), 2U);
    EXPECT_EQ(rig.done, 1);
}

TEST(RigLink, SilentRigIsAnErrorAfterThreeSends) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.deaf = true;
    const Nanoseconds start = rig.clock().now();
    const auto answer = link->command(Op::Ping);
    ASSERT_FALSE(answer);
    EXPECT_TRUE(mentions(answer.error(), "PING to rig TEST-0001: no ACK after 3 sends"));
    EXPECT_EQ(rig.log.size(), 3U);
    EXPECT_EQ(rig.clock().now() - start, 300ms);
    EXPECT_TRUE(mentions(*link->lost(), "it answers, but takes no commands"));
}

TEST(RigLink, AfterThreeSendsAProbeSaysWhyTheRigIsLost) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.deaf = rig.mute = true;
    ++rig.ident.bootId;
    for (const auto at : {100ms, 200ms}) rig.sendInput({0x7F}, at);  // reports are not silent
    const auto answer = link->command(Op::Ping);
    ASSERT_FALSE(answer);
    EXPECT_TRUE(mentions(answer.error(), "has rebooted")) << answer.error().message;
    EXPECT_TRUE(link->lost());
}

TEST(RigLink, LateAckOfARepeatedCommandStraysHarmlessly) {
    ScriptedRig rig;
    rig.mute = true;
    const auto link = opened(rig);
    rig.ackDelay = 120ms;
    rig.noLastAck = true;
    EXPECT_TRUE(link->command(Op::Ping));
    EXPECT_EQ(rig.done, 1);
    rig.ackDelay = 0ms;
    rig.pass(200ms);
    EXPECT_TRUE(link->command(Op::Flush));
    EXPECT_EQ(link->counters().strayAcks, 1U);
}

TEST(RigLink, BusyIsRepeatedAfterItsPause) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.before = {Ack{.status = status::kBusy, .retryMs = 50},
                  Ack{.status = status::kBusy, .retryMs = 50}};
    const Nanoseconds start = rig.clock().now();
    EXPECT_TRUE(link->command(Op::Flush));
    EXPECT_EQ(rig.clock().now() - start, 100ms);
    EXPECT_EQ(rig.log[0], rig.log[2]);
    EXPECT_EQ(link->counters().repeats, 0U) << "BUSY is an answer, not a loss";
}

TEST(RigLink, RigThatStaysBusyIsAnError) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.refuse[Op::Flush] = status::kBusy;
    const auto answer = link->command(Op::Flush);
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().kind, ErrorKind::Busy);
    EXPECT_LE(rig.clock().now(), 6s);
}

TEST(RigLink, PendingExtendsTheWait) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.before = {Ack{.status = status::kPending, .retryMs = 700}};
    EXPECT_TRUE(link->command(Op::Flush));
    EXPECT_EQ(rig.log.size(), 1U);
    EXPECT_EQ(rig.clock().now(), 700ms);
}

TEST(RigLink, AcksOfOtherSessionsAreNotOurs) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.sendInput(encode(Ack{.sequence = 1, .op = Op::Flush, .status = 900, .sessionLow = 5}));
    EXPECT_TRUE(link->command(Op::Flush));
    EXPECT_EQ(link->counters().foreignAcks, 1U);
}

TEST(RigLink, BadAndUnknownReportsAreCounted) {
    ScriptedRig rig;
    const auto link = opened(rig);
    Report bad = encode(Event{});
    bad[7] ^= 1;
    rig.sendInput(bad);
    rig.sendInput(encode(Stats{}));  // sound, but no input report of this table
    EXPECT_TRUE(link->command(Op::Ping));
    EXPECT_EQ(link->counters().badReports, 1U);
    EXPECT_EQ(link->counters().unknownReports, 1U);
}

TEST(RigLink, RefusedCommandCarriesItsStatus) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.refuse = {{Op::SetLed, status::kInterlock}, {Op::Arm, status::kNotOwner}};
    const auto dark = link->command(Op::SetLed);
    ASSERT_FALSE(dark);
    EXPECT_EQ(dark.error().deviceStatus, status::kInterlock);
    EXPECT_EQ(dark.error().message, "SET_LED to rig TEST-0001: INTERLOCK");
    EXPECT_EQ(link->command(Op::Arm).error().kind, ErrorKind::Busy);
}

TEST(RigLink, FeedsTheHeartbeatWhileItWaitsForChunks) {
    ScriptedRig rig;
    const auto link = opened(rig);
    const auto nothing = link->readBulk(10s);
    ASSERT_TRUE(nothing);
    EXPECT_FALSE(*nothing);
    EXPECT_GE(rig.clock().now(), 10s);
    EXPECT_LE(rig.longestSilence, 500ms) << "heartbeat_ms / 4";
}

TEST(RigLink, KeepAliveSendsAPingOnlyWhenDue) {
    ScriptedRig rig;
    const auto link = opened(rig);
    EXPECT_TRUE(link->keepAlive());
    EXPECT_EQ(rig.log.size(), 0U);
    rig.pass(450ms);
    EXPECT_TRUE(link->keepAlive());
    EXPECT_EQ(rig.count(Op::Ping), 1);
}

TEST(RigLink, StatusIsFreshOrAnError) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.state = RigState::Exposing;
    const auto now = link->freshStatus();
    ASSERT_TRUE(now);
    EXPECT_EQ(now->state, RigState::Exposing);
    rig.mute = true;
    const Nanoseconds start = rig.clock().now();
    EXPECT_FALSE(link->freshStatus());
    EXPECT_LE(rig.clock().now() - start, 900ms);
    EXPECT_EQ(link->reopens(), 2U);
    EXPECT_TRUE(link->lost()) << "so that it may come back";
}

TEST(RigLink, StatusIsAwaitedUntilSilentReportsWereOpenedAnew) {
    for (const int reopens : {1, 2}) {
        ScriptedRig rig;
        const auto link = opened(rig);
        rig.mute = true;
        rig.reopensToHear = reopens;
        const auto now = link->freshStatus();
        ASSERT_TRUE(now) << now.error().message;
        EXPECT_EQ(link->reopens(), static_cast<std::uint32_t>(reopens));
    }
}

TEST(RigLink, ARigThatSaysAllButItsStatusIsAnError) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.mute = true;
    for (int i = 0; i < 100; ++i) rig.sendInput({0x7F}, i * 100ms);
    const Nanoseconds start = rig.clock().now();
    EXPECT_FALSE(link->freshStatus());
    EXPECT_LE(rig.clock().now() - start, 2s);
}

TEST(RigLink, RebootIsAnError) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.ident.bootId = 2;
    const auto now = link->freshStatus();
    ASSERT_FALSE(now);
    EXPECT_TRUE(mentions(now.error(), "rebooted"));
}

TEST(RigLink, EventsAreReadAgainWhenTheirReportsAreLost) {
    ScriptedRig rig;
    rig.raise({.sequence = 1, .code = event::kBoot}, false);  // before the link was opened
    const auto link = opened(rig);
    const Event opened2{.sequence = 2, .code = event::kInterlockOpened};
    const Event closed3{.sequence = 3, .code = event::kInterlockClosed};
    const Event removed4{.sequence = 4, .code = event::kModuleRemoved};
    rig.raise(opened2, true);
    rig.raise(closed3, false);
    rig.raise(removed4, true);
    const auto events = link->takeEvents();
    ASSERT_TRUE(events);
    EXPECT_EQ(*events, (std::vector<Event>{opened2, closed3, removed4}));
    EXPECT_TRUE(link->takeEvents()->empty());
}

TEST(RigLink, EventsWhoseReportsAreLostAreReadAgainBeforeTheRigForgetsThem) {
    ScriptedRig rig;
    const auto link = opened(rig);
    constexpr std::uint32_t kAll = 300;  // the rig keeps 64
    for (std::uint32_t n = 1; n <= kAll; ++n) {
        rig.raise({.sequence = n, .code = event::kInterlockOpened}, false);
        if (n % 50 != 0) continue;
        rig.pass(100ms);  // a STATUS says that there is something
        ASSERT_TRUE(link->keepAlive());
    }
    const auto events = link->takeEvents();
    ASSERT_TRUE(events);
    ASSERT_EQ(events->size(), kAll);
    for (std::uint32_t n = 1; n <= kAll; ++n) EXPECT_EQ((*events)[n - 1].sequence, n);
    EXPECT_EQ(link->counters().missedEvents, 0U);
}

TEST(RigLink, EventsThatTheRigHasForgottenAreCounted) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.raise({.sequence = 6, .code = event::kBoot}, false);  // 1..5 are gone
    EXPECT_EQ(link->takeEvents()->size(), 1U);
    EXPECT_EQ(link->counters().missedEvents, 5U);
}

TEST(RigLink, EventsThatCouldNotBeReadAreReadAtTheNextStatus) {
    for (int ScriptedRig::*const trouble :
         {&ScriptedRig::spoilEvents, &ScriptedRig::refuseEvents}) {
        ScriptedRig rig;
        const auto link = opened(rig);
        const Event opened1{.sequence = 1, .code = event::kInterlockOpened};
        rig.raise(opened1, false);
        const int looks = rig.eventPages;
        rig.*trouble = 1;
        rig.pass(100ms);
        for (int i = 0; i < 10; ++i) ASSERT_TRUE(link->keepAlive());
        EXPECT_EQ(rig.eventPages, looks + 1) << "one look each STATUS";
        EXPECT_EQ(link->counters().badReports, 1U);
        rig.pass(100ms);
        ASSERT_TRUE(link->keepAlive());
        EXPECT_EQ(rig.eventPages, looks + 2);
        rig.*trouble = 1;
        const auto events = link->takeEvents();
        ASSERT_TRUE(events) << events.error().message;
        EXPECT_EQ(*events, (std::vector<Event>{opened1}));
    }
}

TEST(RigLink, ARigThatPromisesEventsItDoesNotHaveCostsOneLook) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.promisedEvents = 1000;
    rig.pass(100ms);
    ASSERT_TRUE(link->keepAlive());
    const int looks = rig.eventPages;
    for (int i = 0; i < 20; ++i) {
        rig.pass(100ms);
        ASSERT_TRUE(link->keepAlive());
    }
    EXPECT_EQ(rig.eventPages, looks);
}

TEST(RigLink, GapsInTheNumbersOfStatusAreCounted) {
    ScriptedRig rig;
    const auto link = opened(rig);
    const auto say = [&](std::uint16_t sequence) {
        rig.sendInput(encode(Status{.sequence = sequence, .bootId = rig.ident.bootId}));
        ASSERT_TRUE(link->keepAlive());
    };
    rig.mute = true;
    say(65533);
    say(65534);
    EXPECT_EQ(link->counters().lostStatuses, 0U);
    say(2);  // 65535, 0 and 1 are missing
    EXPECT_EQ(link->counters().lostStatuses, 3U);
    say(2);
    say(1);
    EXPECT_EQ(link->counters().lostStatuses, 3U) << "what comes twice is no gap";
}

TEST(RigLink, TheTimeOfTheRigMeansNothing) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.mute = true;
    std::uint32_t number = 0;
    for (const std::uint64_t time : {5'000'000ULL, 3ULL, ~0ULL, 0ULL}) {
        rig.sendInput(encode(Status{.sequence = static_cast<std::uint16_t>(number),
                                    .bootId = rig.ident.bootId,
                                    .timeUs = time}));
        rig.raise({.sequence = ++number, .timeUs = time, .code = event::kBoot}, true);
        ASSERT_TRUE(link->keepAlive());
        EXPECT_EQ(link->status()->timeUs, time);
    }
    EXPECT_EQ(link->takeEvents()->size(), 4U);
    EXPECT_EQ(link->counters(), LinkCounters{});
}

TEST(RigLink, ACommandThatTheRigDidNotTakeIsSentAgainWhileItAnswers) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.refuseWrites = 2;
    EXPECT_TRUE(link->command(Op::Flush));
    EXPECT_EQ(rig.done, 1);
    EXPECT_FALSE(link->lost());
}

TEST(RigLink, APauseThatIsTooLongIsCutShort) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.before = {Ack{.status = status::kBusy, .retryMs = 65535}};
    EXPECT_TRUE(link->command(Op::Flush));
    EXPECT_LE(rig.clock().now(), 500ms) << "the heartbeat is fed";
    rig.noLastAck = true;
    rig.before = {Ack{.status = status::kPending, .retryMs = 65535},
                  Ack{.status = status::kPending, .retryMs = 65535},
                  Ack{.status = status::kPending, .retryMs = 65535}};
    const Nanoseconds begin = rig.clock().now();
    (void)link->command(Op::Flush);
    EXPECT_LE(rig.clock().now() - begin, 31s);
}

TEST(RigLink, AClaimThatHasLapsedIsALoss) {
    ScriptedRig rig;
    const auto link = opened(rig);
    rig.session.owner = Owner::Lapsed;
    const auto answer = link->command(Op::Ping);
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().kind, ErrorKind::Busy);
    ASSERT_TRUE(link->lost());
    ASSERT_TRUE(link->resume(rig));
    EXPECT_TRUE(link->command(Op::Ping));
    EXPECT_EQ(rig.session.owner, Owner::Alive);
}

TEST(RigLink, ReadsStatistics) {
    ScriptedRig rig;
    EXPECT_EQ(opened(rig)->stats()->commandsDone, 7U);
}

TEST(RigLink, NothingWorksAfterRelease) {
    ScriptedRig rig;
    const auto link = opened(rig);
    EXPECT_TRUE(link->release());
    EXPECT_TRUE(link->release()) << "twice is once";
    EXPECT_EQ(link->command(Op::Ping).error().kind, ErrorKind::Usage);
    EXPECT_TRUE(rig.log.empty());
}

}  // namespace
}  // namespace gonio::driver
