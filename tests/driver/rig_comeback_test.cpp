// A rig that is lost and comes back, at every call that a capture makes.

#include "driver/protocol/fault_limit.h"
#include "tests/driver/loose_cable.h"
#include "tests/driver/planned_capture.h"

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;
using namespace test;

const CaptureRequest kNext{.planStep = 6,
                           .led = 1,
                           .levels = LedLevels::only(Band::B, 30000),
                           .exposure = Microseconds(2000),
                           .frames = 2};

/// A configured rig on a cable, which comes back unless a test says otherwise.
struct Bench {
    Bench() {
        auto opened = Rig::open(plugs.cable(), kSession);
        EXPECT_TRUE(opened) << opened.error().message;
        rig.emplace(std::move(*opened));
        EXPECT_TRUE(rig->configure(kWindow));
        rig->onLost(plugs.comeback());
    }
    void breakAfter(long calls) { plugs.cable().breaksAt = plugs.cable().calls + calls; }
    /// While the second frame comes.
    void breakInTheStream() {
        device.onStream = first(1, [this](std::vector<Bytes>&) { breakAfter(25); });
    }

    ScriptedRig device;
    std::function<void()> broken = [this] { device.linkLost(); };
    Replugged plugs{device, [this] { broken(); }};
    std::optional<Rig> rig;
};

class RigComeback : public testing::Test, protected Bench {};

/// What `work` does with a rig whose cable breaks at each call that it makes; how many those are.
template <class Work>
int atEachCall(const Work& work) {
    for (int cut = 0;; ++cut) {
        SCOPED_TRACE("call " + std::to_string(cut));
        Bench bench;
        bench.breakAfter(cut);
        work(bench);
        EXPECT_EQ(bench.plugs.touches(), 0) << "a dead transport was touched";
        if (bench.plugs.losses.empty() || testing::Test::HasFailure()) return cut;
    }
}

TEST(RigComebackAnywhere, SameBootAtAnyCallCostsNoFrame) {
    const int calls = atEachCall([](Bench& bench) {
        const auto capture = bench.rig->capture(kRequest, {kNext});
        expectUndisturbed(capture, kRequest);
        EXPECT_EQ(capture->recaptures, 0) << "no fault of the rig";
        expectUndisturbed(bench.rig->capture(kNext), kNext);
        const auto gaps = bench.rig->takeInterruptions();
        EXPECT_EQ(gaps.size(), bench.plugs.losses.size());
        EXPECT_TRUE(bench.rig->takeInterruptions().empty());
        for (const Interruption& gap : gaps) {
            EXPECT_TRUE(gap.sameBoot);
            EXPECT_NE(gap.cause.find("the cable is broken"), std::string::npos) << gap.cause;
            EXPECT_LE(gap.resent + gap.redone, kRequest.frames);
        }
    });
    EXPECT_GT(calls, 60) << "both captures were broken everywhere";
}

TEST(RigComebackAnywhere, TheLastAckTellsWhetherTheCommandThatWasCutOffWasDone) {
    int unheard = 0, done = 0, none = 0;
    (void)atEachCall([&](Bench& bench) {
        expectUndisturbed(bench.rig->capture(kRequest), kRequest);
        for (const Interruption& gap : bench.rig->takeInterruptions()) {
            const bool atWrite = bench.plugs.cables.front()->brokeAtWrite;
            unheard += atWrite ? 1 : 0;
            EXPECT_EQ(gap.cutOffDone == false, atWrite) << "every command that was heard is done";
            done += gap.cutOffDone.value_or(false) ? 1 : 0;
            none += gap.cutOffDone ? 0 : 1;
            EXPECT_EQ(gap.stats.value().commandsDone, 7U) << "read again";
        }
    });
    EXPECT_GE(unheard, 3) << "SET_LED, SET_EXPOSURE, ARM";
    EXPECT_GE(done, 3) << "the same, their ACKs lost";
    EXPECT_GE(none, 10) << "in the stream";
}

TEST_F(RigComeback, AnotherBootHasDoneNothingOfWhatWasCutOff) {
    broken = [&] { device.powerLost(); };
    breakAfter(1);  // SET_LED is sent, its ACK is awaited
    EXPECT_FALSE(rig->capture(kRequest));
    const auto gaps = rig->takeInterruptions();
    ASSERT_EQ(gaps.size(), 1U);
    EXPECT_EQ(gaps[0].cutOffDone, false);
}

TEST(RigComebackAnywhere, ASinkIsGivenEachFrameOnce) {
    const int calls = atEachCall([](Bench& bench) {
        Capture given;
        const auto capture = bench.rig->capture(kRequest, {}, [&](Frame frame) -> Result<void> {
            given.frames.push_back(std::move(frame));
            return {};
        });
        EXPECT_TRUE(capture) << capture.error().message;
        expectUndisturbed(given, kRequest);
    });
    EXPECT_GT(calls, 20);
}

TEST_F(RigComeback, FramesThatTheRigHoldsAreSentAgainAndNotExposedAgain) {
    breakInTheStream();
    const auto capture = rig->capture(kRequest);
    expectUndisturbed(capture, kRequest);
    const auto gaps = rig->takeInterruptions();
    ASSERT_EQ(gaps.size(), 1U);
    EXPECT_GE(gaps[0].resent, 1);
    EXPECT_EQ(gaps[0].redone, 0);
    EXPECT_EQ(device.count(Op::Arm), 1);
    EXPECT_EQ(device.count(Op::Abort), 1) << "dark and idle before anything else";
}

TEST_F(RigComeback, FramesThatTheRigDoesNotHoldAreExposedAgainWithTheirLed) {
    broken = [&] {
        device.linkLost();
        device.forgetFrames();
    };
    breakInTheStream();
    const auto capture = rig->capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->recaptures, 0);
    const auto gaps = rig->takeInterruptions();
    ASSERT_EQ(gaps.size(), 1U);
    EXPECT_EQ(gaps[0].resent, 0);
    EXPECT_GE(gaps[0].redone, 1);
    EXPECT_EQ(device.count(Op::Arm), 2);
    EXPECT_EQ(device.led.levels[0], 65535) << "lit again";
}

TEST_F(RigComeback, ARigThatCannotResendExposesAgain) {
    ScriptedRig poor;
    poor.ident.capabilities = 0;
    Replugged its(poor, [&] { poor.linkLost(); });
    auto one = Rig::open(its.cable(), kSession);
    ASSERT_TRUE(one->configure(kWindow));
    one->onLost(its.comeback());
    poor.onStream =
        first(1, [&](std::vector<Bytes>&) { its.cable().breaksAt = its.cable().calls + 25; });
    expectUndisturbed(one->capture(kRequest), kRequest);
    EXPECT_EQ(poor.count(Op::Resend), 0);
    EXPECT_EQ(poor.count(Op::Arm), 2);
}

TEST(RigComebackAnywhere, AnotherBootIsToldByTheCaptureThatItInterrupts) {
    const int calls = atEachCall([](Bench& bench) {
        bench.broken = [&] { bench.device.powerLost(); };
        Rig* const rig = &*bench.rig;
        const std::uint32_t before = rig->bootId();
        const auto capture = rig->capture(kRequest);
        if (bench.plugs.losses.empty()) return expectUndisturbed(capture, kRequest);
        EXPECT_FALSE(capture);
        if (!capture) {
            EXPECT_EQ(capture.error().kind, ErrorKind::Device);
            EXPECT_TRUE(mentions(capture.error(), "redo the bracket")) << capture.error().message;
        }
        EXPECT_NE(rig->bootId(), before);
        EXPECT_EQ(rig->identify().ident.bootId, rig->bootId());
        EXPECT_EQ(bench.device.led, SetLed{}) << "dark after an error";
        expectUndisturbed(rig->capture(kRequest), kRequest);  // its format was set again
        const auto gaps = rig->takeInterruptions();
        EXPECT_EQ(gaps.size(), 1U);
        EXPECT_FALSE(gaps.empty() || gaps[0].sameBoot);
    });
    EXPECT_GT(calls, 30);
}

TEST_F(RigComeback, AnotherBootBetweenCapturesIsToldByTheNextOneOnce) {
    broken = [&] { device.powerLost(); };
    for (const bool byDarken : {true, false}) {
        breakAfter(0);
        if (byDarken) {
            EXPECT_TRUE(rig->darken()) << "dark it is";
        } else {
            EXPECT_TRUE(rig->keepAlive());
        }
        const auto told = rig->capture(kRequest);
        ASSERT_FALSE(told);
        EXPECT_TRUE(mentions(told.error(), "redo the bracket"));
        expectUndisturbed(rig->capture(kRequest), kRequest);
    }
}

TEST_F(RigComeback, AnotherBootThatIsTakenIsToldByNoCapture) {
    broken = [&] { device.powerLost(); };
    EXPECT_FALSE(rig->takeReboot());
    breakAfter(0);
    EXPECT_TRUE(rig->keepAlive());
    const auto reboot = rig->takeReboot();
    ASSERT_TRUE(reboot);
    EXPECT_TRUE(mentions(*reboot, "redo the bracket")) << reboot->message;
    EXPECT_FALSE(rig->takeReboot());
    expectUndisturbed(rig->capture(kRequest), kRequest);
}

TEST_F(RigComeback, AnotherBootThatACaptureHasToldIsThereToBeTaken) {
    broken = [&] { device.powerLost(); };
    breakInTheStream();
    ASSERT_FALSE(rig->capture(kRequest));
    EXPECT_TRUE(rig->takeReboot());
    expectUndisturbed(rig->capture(kRequest), kRequest);
    EXPECT_FALSE(rig->takeReboot());
    breakAfter(0);
    EXPECT_TRUE(rig->keepAlive());
    EXPECT_TRUE(rig->configure(kWindow));
    EXPECT_FALSE(rig->takeReboot()) << "what is configured anew is taken anew";
}

TEST(RigComebackAnywhere, AnotherBootIsToldThoughItsOwnerGaveUpOnTheWay) {
    for (int cut = 0; cut < 20; ++cut) {
        SCOPED_TRACE("the second cable breaks at call " + std::to_string(cut));
        Bench bench;
        int losses = 0;
        bench.broken = [&] { losses++ == 0 ? bench.device.powerLost() : bench.device.linkLost(); };
        bench.plugs.onPlug = [&](LooseCable& cable) { cable.breaksAt = cut; };
        int tries = 0;
        bench.rig->onLost([&](const Error& lost) -> Result<Transport*> {
            if (tries++ > 0) return Error{ErrorKind::Interrupted, "the job was cancelled"};
            return bench.plugs.comeback()(lost);
        });
        bench.breakAfter(0);
        (void)bench.rig->keepAlive();
        bench.plugs.onPlug = {};
        bench.rig->onLost(bench.plugs.comeback());
        const auto told = bench.rig->capture(kRequest);
        ASSERT_FALSE(told);
        EXPECT_TRUE(mentions(told.error(), "redo the bracket")) << told.error().message;
        expectUndisturbed(bench.rig->capture(kRequest), kRequest);
    }
}

TEST_F(RigComeback, ConfigureBeginsAnewWithAnotherBoot) {
    broken = [&] { device.powerLost(); };
    breakAfter(0);
    EXPECT_TRUE(rig->configure(kWindow));
    expectUndisturbed(rig->capture(kRequest), kRequest);
    EXPECT_EQ(plugs.losses.size(), 1U);
}

TEST_F(RigComeback, AnotherSerialIsRefusedByNameAndTheOwnerIsAskedAgain) {
    int others = 3;
    plugs.onPlug = [&](LooseCable& cable) {
        if (others-- > 0) cable.serial = "TEST-0002";
    };
    breakAfter(30);
    expectUndisturbed(rig->capture(kRequest), kRequest);
    ASSERT_EQ(plugs.losses.size(), 4U);
    EXPECT_TRUE(mentions(plugs.losses[1], "TEST-0001")) << plugs.losses[1].message;
    EXPECT_TRUE(mentions(plugs.losses[1], "TEST-0002")) << plugs.losses[1].message;
    EXPECT_EQ(plugs.losses[1].kind, ErrorKind::Device);
    EXPECT_EQ(rig->takeInterruptions().size(), 1U);
    EXPECT_EQ(plugs.touches(), 0);
    EXPECT_EQ(plugs.cables[1]->calls, 0) << "nothing was asked of the other rig";
}

TEST_F(RigComeback, ARigThatIsLostAgainWhileItComesBackIsAwaitedAgain) {
    int cut = 0;
    plugs.onPlug = [&](LooseCable& cable) {
        if (cut < 20) cable.breaksAt = cut++;
    };
    breakAfter(30);
    const auto capture = rig->capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(plugs.losses.size(), 21U);
    EXPECT_EQ(plugs.touches(), 0);
}

TEST_F(RigComeback, ItsOwnerAloneSaysHowOftenItIsTriedAndHearsWhenItIsBack) {
    constexpr std::size_t kTries = 2000;
    plugs.onPlug = [&](LooseCable& cable) {
        if (plugs.losses.size() < kTries) cable.breaksAt = 0;
    };
    std::size_t backs = 0, lossesBefore = 0;
    rig->onBack([&] {
        ++backs;
        lossesBefore = plugs.losses.size();
    });
    breakAfter(30);
    expectUndisturbed(rig->capture(kRequest), kRequest);
    EXPECT_EQ(backs, 1U);
    EXPECT_EQ(lossesBefore, kTries) << "not before it was taken up";
    EXPECT_EQ(plugs.losses.size(), kTries);
}

TEST_F(RigComeback, WhenItsOwnerGivesUpTheCallEndsWithItsReason) {
    rig->onLost([](const Error&) -> Result<Transport*> {
        return Error{ErrorKind::Interrupted, "the job was cancelled"};
    });
    breakAfter(30);
    const auto capture = rig->capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().kind, ErrorKind::Interrupted);
    EXPECT_TRUE(mentions(capture.error(), "the job was cancelled"));
    plugs.cable().over = true;
    EXPECT_FALSE(rig->status()) << "lost it stays";
    rig->onLost(plugs.comeback());
    expectUndisturbed(rig->capture(kRequest), kRequest);
    EXPECT_EQ(plugs.touches(), 0);
}

TEST_F(RigComeback, WithoutAComebackALossIsAnErrorAndNothingIsTouchedAfterwards) {
    rig->onLost({});
    breakAfter(30);
    EXPECT_EQ(rig->capture(kRequest).error().kind, ErrorKind::Device);
    plugs.cable().over = true;
    EXPECT_FALSE(rig->capture(kRequest));
    EXPECT_FALSE(rig->darken());
    const Nanoseconds then = rig->link().clock().now();
    device.pass(5s);
    EXPECT_EQ(rig->link().clock().now(), then) << "its clock stands still";
    rig.reset();
    EXPECT_EQ(plugs.touches(), 0);
}

TEST_F(RigComeback, EventsOfTheGapAreThereAndNoneTwice) {
    device.raise({.sequence = 1, .code = event::kInterlockOpened}, true);
    broken = [&] {
        device.linkLost();
        device.raise({.sequence = 2, .code = event::kLinkLost, .arg0 = 3}, false);
    };
    breakAfter(30);
    expectUndisturbed(rig->capture(kRequest), kRequest);
    const auto events = rig->link().takeEvents();
    ASSERT_TRUE(events);
    ASSERT_EQ(events->size(), 2U);
    EXPECT_EQ((*events)[0].code, event::kInterlockOpened);
    EXPECT_EQ((*events)[1].code, event::kLinkLost);
}

TEST_F(RigComeback, ALapsedClaimIsTakenUpAgain) {
    device.session.owner = Owner::Lapsed;  // the computer slept
    device.led = {};
    expectUndisturbed(rig->capture(kRequest), kRequest);
    ASSERT_EQ(plugs.losses.size(), 1U);
    EXPECT_EQ(plugs.losses[0].deviceStatus, status::kNotOwner);
    EXPECT_EQ(plugs.cables[0]->resets, 0) << "nothing hangs";
}

TEST_F(RigComeback, ARigThatRestartsOnTheBusIsTakenUpAgain) {
    device.powerLost();  // the cable is fine
    EXPECT_TRUE(rig->keepAlive());
    const auto told = rig->capture(kRequest);
    ASSERT_FALSE(told);
    EXPECT_TRUE(mentions(told.error(), "redo the bracket")) << told.error().message;
    expectUndisturbed(rig->capture(kRequest), kRequest);
}

TEST_F(RigComeback, ARigThatHangsHasItsPortResetOnceAndIsLost) {
    device.deaf = true;
    plugs.onPlug = [&](LooseCable&) { device.deaf = false; };
    expectUndisturbed(rig->capture(kRequest), kRequest);
    EXPECT_EQ(plugs.losses.size(), 1U);
    EXPECT_TRUE(mentions(plugs.losses[0], "no ACK after 3 sends"));
    EXPECT_EQ(plugs.cables[0]->resets, 1);
}

TEST_F(RigComeback, AFaultOfTheStreamEndsTheCaptureAndNobodyIsAskedToComeBack) {
    device.onStream = first(
        1, [this](std::vector<Bytes>&) { plugs.cable().fault = streamFault("rig TEST-0001"); });
    const auto capture = rig->capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_TRUE(mentions(capture.error(), "three times in 10 s")) << capture.error().message;
    EXPECT_TRUE(plugs.losses.empty());
    plugs.cable().over = true;
    EXPECT_FALSE(rig->status()) << "lost it stays";
    plugs.cable().over = false;
    expectUndisturbed(rig->capture(kRequest), kRequest);  // the next call asks
    EXPECT_EQ(plugs.losses.size(), 1U);
    device.onStream = first(
        1, [this](std::vector<Bytes>&) { plugs.cable().fault = streamFault("rig TEST-0001"); });
    EXPECT_FALSE(rig->capture(kRequest)) << "another fault is told as the first was";
    EXPECT_EQ(plugs.losses.size(), 1U);
}

TEST_F(RigComeback, ReportsThatStaySilentForGoodEndTheCall) {
    for (const auto exposure : {Microseconds(1000), Microseconds(1'000'000)}) {
        SCOPED_TRACE(std::to_string(exposure.count()) + " us");
        device.mute = true;
        device.onStream = [](std::vector<Bytes>& chunks) { chunks.clear(); };
        plugs.losses.clear();
        CaptureRequest request = kRequest;
        request.exposure = exposure;
        const auto capture = rig->capture(request);
        ASSERT_FALSE(capture);
        EXPECT_TRUE(mentions(capture.error(), "times in one call")) << capture.error().message;
        EXPECT_TRUE(mentions(capture.error(), "stay silent")) << capture.error().message;
        EXPECT_GT(plugs.losses.size(), 5U);
        EXPECT_LT(plugs.losses.size(), 50U);
        device.mute = false;
        device.onStream = {};
        expectUndisturbed(rig->capture(kRequest), kRequest);
    }
}

/// The second of three frames and the third are on their way.
Result<Capture> captureWithAGapInTheSink(Bench& bench, Capture& given) {
    return bench.rig->capture(kRequest, {}, [&](Frame frame) -> Result<void> {
        given.frames.push_back(std::move(frame));
        if (given.size() > 1) return {};
        bench.breakAfter(0);
        return bench.rig->keepAlive();
    });
}

TEST(RigComebackInASink, CostsNoFrameAndIsNoFaultOfTheRig) {
    for (const bool held : {true, false}) {
        Bench bench;
        if (!held) {
            bench.broken = [&] {
                bench.device.linkLost();
                bench.device.forgetFrames();
            };
        }
        Capture given;
        const auto capture = captureWithAGapInTheSink(bench, given);
        ASSERT_TRUE(capture) << capture.error().message;
        expectUndisturbed(given, kRequest);
        EXPECT_EQ(capture->recaptures + capture->resends, 0);
        const auto gaps = bench.rig->takeInterruptions();
        ASSERT_EQ(gaps.size(), 1U);
        EXPECT_EQ(gaps[0].resent, held ? 2 : 0);
        EXPECT_EQ(gaps[0].redone, held ? 0 : 2);
    }
}

TEST(RigComebackInASink, AnotherBootEndsTheCapture) {
    Bench bench;
    bench.broken = [&] { bench.device.powerLost(); };
    Capture given;
    const auto capture = captureWithAGapInTheSink(bench, given);
    ASSERT_FALSE(capture);
    EXPECT_TRUE(mentions(capture.error(), "redo the bracket")) << capture.error().message;
    EXPECT_EQ(given.size(), 1U);
    EXPECT_EQ(bench.device.count(Op::Resend), 0) << "there is nothing to ask another boot for";
}

TEST_F(RigComeback, TheClockGoesOnAndNeverBack) {
    device.pass(10s);
    Nanoseconds last = rig->link().clock().now();
    ScriptedRig younger;  // the same rig, behind another transport whose clock begins at 0
    younger.ident = device.ident;
    rig->onLost([&](const Error&) -> Result<Transport*> { return &younger; });
    breakAfter(10);
    expectUndisturbed(rig->capture(kRequest), kRequest);
    EXPECT_GE(rig->link().clock().now(), last);
    const auto gaps = rig->takeInterruptions();
    ASSERT_EQ(gaps.size(), 1U);
    EXPECT_GE(gaps[0].at, last);
    EXPECT_GE(gaps[0].lasted, 0ns);
    rig.reset();  // before the younger one
}

}  // namespace
}  // namespace gonio::driver
