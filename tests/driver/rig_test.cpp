#include "driver/rig.h"

#include <gtest/gtest.h>

#include "tests/driver/planned_capture.h"

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;
using namespace test;

TEST(Rig, TellsWhoItIs) {
    ScriptedRig device;
    const Rig rig = configured(device);
    const RigInfo info = rig.identify();
    EXPECT_EQ(info.serial, "TEST-0001");
    ASSERT_EQ(info.ledAngles.size(), 4U);
    EXPECT_NEAR(info.ledAngles[3].degrees(), 60, 1e-12);
    EXPECT_EQ(info.sensor, (Size{64, 48}));
    EXPECT_EQ(info.exposureMax, Microseconds(1000000));
    EXPECT_EQ(info.ident, device.ident);
    EXPECT_EQ(info.limits, device.limits);
}

TEST(Rig, TakesFramesAsPlanned) {
    ScriptedRig device;
    Rig rig = configured(device);
    const auto capture = rig.capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->front().captureId, 0x50001U);
    EXPECT_EQ(capture->anomalies, Anomalies{});
    EXPECT_EQ(capture->resends + capture->recaptures + capture->discarded, 0);
    EXPECT_EQ(device.led.led, 2) << "kept lit";
}

TEST(Rig, TakesDarkFrames) {
    ScriptedRig device;
    Rig rig = configured(device);
    const auto capture = rig.capture({.planStep = 1, .exposure = Microseconds(50)});
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_FALSE((*capture)[0].led);
    EXPECT_TRUE((*capture)[0].levels.dark());
}

TEST(Rig, RefusesCaptureBeforeConfigure) {
    ScriptedRig device;
    auto rig = Rig::open(device, kSession);
    ASSERT_TRUE(rig);
    const auto capture = rig->capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().kind, ErrorKind::Usage);
    EXPECT_TRUE(device.log.empty());
}

TEST(Rig, RefusesRequestsOutOfTheRigsDomain) {
    ScriptedRig device;
    Rig rig = configured(device);
    const auto refused = [&](auto change) {
        CaptureRequest request = kRequest;
        change(request);
        const auto capture = rig.capture(request);
        return !capture && capture.error().kind == ErrorKind::Usage;
    };
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.frames = 0; }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.frames = 17; }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.led = 4; }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.led = -1; }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.led.reset(); }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.exposure = Microseconds(19); }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.exposure = Microseconds(1000001); }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.gainDb = 24.01; }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.gainDb = std::nan(""); }));
    EXPECT_TRUE(refused([](CaptureRequest& r) { r.planStep = std::uint64_t{1} << 48; }));
    EXPECT_FALSE(refused([](CaptureRequest& r) { r.exposure = Microseconds(20); }));
    EXPECT_FALSE(refused([](CaptureRequest& r) { r.gainDb = 24; }));
}

TEST(Rig, RefusesWindowsOfNoSensor) {
    ScriptedRig device;
    Rig rig = configured(device);
    EXPECT_EQ(rig.configure({.size = {0, 4}}).error().kind, ErrorKind::Usage);
    EXPECT_EQ(rig.configure({.x = -2, .size = {4, 4}}).error().kind, ErrorKind::Usage);
    EXPECT_EQ(rig.configure({.size = {8, 8}, .binning = 0}).error().kind, ErrorKind::Usage);
    EXPECT_EQ(device.count(Op::SetFormat), 1) << "only configured()'s own";
}

TEST(Rig, RefusesARigThatCountsOtherBytesPerFrame) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.frameBytesOff = 1000000;
    EXPECT_EQ(rig.configure(kWindow).error().kind, ErrorKind::Device);
    EXPECT_FALSE(rig.capture(kRequest)) << "no longer configured";
}

TEST(Rig, EachLostChunkIsAskedForAgain) {
    for (std::size_t lost = 0; lost < 3 * kChunks; ++lost) {
        ScriptedRig device;
        Rig rig = configured(device);
        device.onStream = first(1, drop(lost));
        const auto capture = rig.capture(kRequest);
        expectUndisturbed(capture, kRequest);
        EXPECT_EQ(capture->resends, 1) << lost;
        EXPECT_EQ(capture->recaptures, 0);
        EXPECT_EQ(device.count(Op::Arm), 1);
    }
}

TEST(Rig, BadChunkIsAskedForAgain) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = first(1, [](std::vector<Bytes>& chunks) { chunks[3][70] ^= 0x10; });
    const auto capture = rig.capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->resends, 1);
    EXPECT_EQ(capture->anomalies.badPayloads, 1U);
    EXPECT_EQ(rig.anomalies(), capture->anomalies);
}

TEST(Rig, FrameThatIsLostWholeIsAskedForAgain) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = first(1, [](std::vector<Bytes>& chunks) {
        chunks.erase(chunks.begin() + kChunks, chunks.begin() + 2 * kChunks);
    });
    const auto capture = rig.capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->resends, 1);
    EXPECT_EQ(capture->anomalies.lostChunks, kChunks);
}

TEST(Rig, CapturesAgainWhenResendsDoNotHelp) {
    ScriptedRig device;
    Rig rig = configured(device);
    // The first send has 21 chunks, its two resends one each: all lose their chunk.
    device.onStream = first(3, [](std::vector<Bytes>& chunks) {
        const std::size_t at = chunks.size() > 1 ? kChunks + 2 : 0;
        chunks[at].back() ^= 1;
    });
    const auto capture = rig.capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->resends, 2);
    EXPECT_EQ(capture->recaptures, 1);
    EXPECT_EQ((*capture)[0].captureId, 0x50001U) << "kept";
    EXPECT_EQ((*capture)[1].captureId, 0x50002U) << "with a new capture_id";
}

TEST(Rig, ASinkIsGivenEachFrameOnceInOrderThroughAllRepairs) {
    for (const int sends : {0, 1, 3}) {  // undisturbed, asked for again, captured again
        ScriptedRig device;
        Rig rig = configured(device);
        device.onStream = first(sends, [](std::vector<Bytes>& chunks) {
            const std::size_t at = chunks.size() > 1 ? kChunks + 2 : 0;
            chunks[at].back() ^= 1;
        });
        Capture given;
        const auto capture = rig.capture(kRequest, {}, [&](Frame frame) -> Result<void> {
            given.frames.push_back(std::move(frame));
            return {};
        });
        ASSERT_TRUE(capture) << capture.error().message;
        EXPECT_EQ(capture->size(), 0U);
        expectUndisturbed(given, kRequest);
    }
}

TEST(Rig, ASinkThatTakesItsTimeMakesNoFrameLate) {
    ScriptedRig device;
    Rig rig = configured(device);
    Capture given;
    const auto capture = rig.capture(kRequest, {}, [&](Frame frame) -> Result<void> {
        given.frames.push_back(std::move(frame));
        device.pass(2s);
        return rig.keepAlive();
    });
    ASSERT_TRUE(capture) << capture.error().message;
    expectUndisturbed(given, kRequest);
    EXPECT_EQ(device.count(Op::Resend), 0);
    EXPECT_EQ(capture->anomalies, Anomalies{});
}

TEST(Rig, AnErrorOfTheSinkEndsTheCapture) {
    ScriptedRig device;
    Rig rig = configured(device);
    int given = 0;
    const auto capture = rig.capture(kRequest, {}, [&](const Frame&) -> Result<void> {
        if (++given < 2) return {};
        return Error{ErrorKind::Quality, "no dark frame"};
    });
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().kind, ErrorKind::Quality);
    EXPECT_TRUE(mentions(capture.error(), "no dark frame")) << capture.error().message;
    EXPECT_EQ(given, 2);
    EXPECT_TRUE(rig.capture(kRequest)) << "the rig is as good as before";
}

TEST(Rig, CapturesAgainWhenTheFrameIsGone) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.refuse[Op::Resend] = status::kFrameGone;
    device.onStream = first(1, drop(2));
    const auto capture = rig.capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->recaptures, 1);
}

TEST(Rig, DoesNotAskARigThatCannotResend) {
    ScriptedRig device;
    device.ident.capabilities = 0;
    Rig rig = configured(device);
    device.onStream = first(1, drop(2));
    expectUndisturbed(rig.capture(kRequest), kRequest);
    EXPECT_EQ(device.count(Op::Resend), 0);
}

TEST(Rig, IgnoresChunksOfAnEarlierCapture) {
    ScriptedRig device;
    Rig rig = configured(device);
    for (Bytes& chunk :
         test::toChunks({.captureId = 0x40001, .pixels = test::picture(kWindow.size, 9)}, 1))
        device.stream.push_back(std::move(chunk));
    const auto capture = rig.capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->anomalies.stale, kChunks);
}

TEST(Rig, DiscardsAndReplacesFramesFromBeforeTheSettings) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.latency = 2;
    device.onFrame = [](FrameToSend& frame) {
        if (frame.leader.frameNumber < 3) frame.leader.led = 0;  // still the old one
    };
    const auto capture = rig.capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->discarded, 2);
    EXPECT_EQ(capture->recaptures, 0) << "being early is no fault";
}

TEST(Rig, WrongLeaderIsCapturedAgain) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onFrame = [](FrameToSend& frame) {
        if (frame.leader.frameNumber == 2) frame.leader.ledLevel[0] = 1;
    };
    const auto capture = rig.capture(kRequest);
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->recaptures, 1);
}

TEST(Rig, WrongLeaderEveryTimeIsAnErrorAfterThreeRecaptures) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onFrame = [](FrameToSend& frame) { frame.leader.led = 1; };
    const auto capture = rig.capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().kind, ErrorKind::Device);
    EXPECT_TRUE(mentions(capture.error(), "capture step 5 (LED 2, 1000 us, 3 frames)"));
    EXPECT_TRUE(mentions(capture.error(), "LEADER led 1, planned 2")) << capture.error().message;
    EXPECT_TRUE(mentions(capture.error(), "3 recaptures"));
    EXPECT_EQ(device.count(Op::Arm), 4);
    EXPECT_EQ(device.led.levels, (std::array<std::uint16_t, 3>{})) << "dark after an error";
}

TEST(Rig, FramesWithoutAllValidityBitsAreNotTaken) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onFrame = [](FrameToSend& frame) { frame.trailer.validity = validity::kInterlock; };
    const auto capture = rig.capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_TRUE(mentions(capture.error(), "LED current left its tolerance"));
}

TEST(Rig, AbortedFrameIsAnErrorWithItsReason) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = first(1, [](std::vector<Bytes>& chunks) {
        ChunkHeader header = decodeChunk(chunks[kChunks])->header;
        header.type = ChunkType::Aborted;
        header.chunkCount = 0;
        const Aborted why{.reason = status::kInterlock, .frameNumber = 2};
        chunks.resize(kChunks);
        chunks.push_back(encodeChunk(header, encode(why)));
    });
    const auto capture = rig.capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().deviceStatus, status::kInterlock);
    EXPECT_EQ(device.count(Op::Arm), 1) << "no second try";
    EXPECT_EQ(device.led.levels, (std::array<std::uint16_t, 3>{}));
}

TEST(Rig, SilentStreamIsAnErrorWithinItsDeadline) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = [](std::vector<Bytes>& chunks) { chunks.clear(); };
    const auto capture = rig.capture(kRequest);
    ASSERT_FALSE(capture);
    // 4 captures x (the first wait and two resends), each of exposure + settling + 2 periods + 500
    // ms.
    EXPECT_LE(device.clock().now(), 12 * 600ms + 4 * 200ms);
    EXPECT_LE(device.longestSilence, 500ms) << "the heartbeat was fed";
}

TEST(Rig, SilentRigIsAnErrorWithinItsDeadline) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.deaf = true;
    const auto capture = rig.capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_TRUE(mentions(capture.error(), "no ACK"));
    EXPECT_LE(device.clock().now(), 1s);
}

TEST(Rig, FaultEndsACapture) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = [&](std::vector<Bytes>& chunks) {
        chunks.clear();
        device.state = RigState::Fault;
        device.fault = status::kOverTemp;
    };
    const auto capture = rig.capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().deviceStatus, status::kOverTemp);
    EXPECT_EQ(device.count(Op::Arm), 1);
}

TEST(Rig, RefusedLedIsAnErrorWithItsStatus) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.refuse[Op::SetLed] = status::kInterlock;
    const auto capture = rig.capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().deviceStatus, status::kInterlock);
    EXPECT_EQ(device.count(Op::Abort), 1) << "made safe all the same";
}

TEST(Rig, RepeatedStepTakesANewCaptureId) {
    ScriptedRig device;
    Rig rig = configured(device);
    EXPECT_EQ(rig.capture(kRequest)->front().captureId, 0x50001U);
    EXPECT_EQ(rig.capture(kRequest)->front().captureId, 0x50002U);
    CaptureRequest next = kRequest;
    next.planStep = 6;
    EXPECT_EQ(rig.capture(next)->front().captureId, 0x60001U);
}

TEST(Rig, CaptureIdThatIsRefusedEachTimeIsAnError) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.refuse[Op::Arm] = status::kBadArg;
    const auto capture = rig.capture(kRequest);
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().deviceStatus, status::kBadArg);
    EXPECT_EQ(device.count(Op::Arm), 8);
}

TEST(Rig, IsDarkAtTheEndWhenAskedTo) {
    ScriptedRig device;
    Rig rig = configured(device);
    CaptureRequest request = kRequest;
    request.keepLit = false;
    EXPECT_TRUE(rig.capture(request));
    EXPECT_EQ(device.led, SetLed{});
}

TEST(Rig, IsDarkAndGivenBackWhenItIsDestroyed) {
    ScriptedRig device;
    {
        Rig rig = configured(device);
        EXPECT_TRUE(rig.capture(kRequest));
        const Rig moved = std::move(rig);
    }
    EXPECT_EQ(device.led, SetLed{});
    EXPECT_EQ(device.count(Op::SetLed), 2);
    EXPECT_EQ(device.session.owner, Owner::None);
}

TEST(Rig, NothingIsTakenAfterClose) {
    ScriptedRig device;
    Rig rig = configured(device);
    EXPECT_TRUE(rig.close());
    EXPECT_EQ(rig.capture(kRequest).error().kind, ErrorKind::Usage);
    EXPECT_EQ(rig.darken().error().kind, ErrorKind::Usage);
}

TEST(Rig, TakesUpItsOwnClaimFromAnIdleRig) {
    ScriptedRig device;
    device.session = {.sessionId = kSession, .lastCommand = 9, .owner = Owner::Alive};
    device.state = RigState::Exposing;
    Rig rig = configured(device);
    EXPECT_EQ(device.log[0].op, Op::Abort);
    EXPECT_EQ(device.log[1].op, Op::Flush);
    EXPECT_EQ(rig.status()->state, RigState::Idle);
}

TEST(Rig, DarkenPutsOutWhatACaptureLeftLit) {
    ScriptedRig device;
    Rig rig = configured(device);
    ASSERT_TRUE(rig.capture(kRequest));
    EXPECT_EQ(device.led.levels[0], 65535);  // keepLit
    ASSERT_TRUE(rig.darken());
    EXPECT_EQ(device.led.levels, (std::array<std::uint16_t, 3>{}));
    EXPECT_TRUE(rig.capture(kRequest));  // and it can be lit again
}

TEST(Rig, ReportsItsStatusAndItsLink) {
    ScriptedRig device;
    Rig rig = configured(device);
    const auto status = rig.status();
    ASSERT_TRUE(status) << status.error().message;
    EXPECT_EQ(status->bootId, test::kBoot);
    EXPECT_EQ(status->state, RigState::Idle);
    EXPECT_EQ(rig.link().strings().serial, "TEST-0001");
    EXPECT_EQ(rig.link().ident(), device.ident);
    EXPECT_EQ(rig.link().clock().now(), device.clock().now());
    device.mute = true;
    EXPECT_FALSE(rig.status());
}

TEST(Rig, KeepsTheHeartbeatWhileItsCallerIsBusy) {
    ScriptedRig device;
    Rig rig = configured(device);
    const int before = device.count(Op::Ping);
    for (int i = 0; i < 10; ++i) {
        ASSERT_TRUE(device.readBulk(500ms));  // half a second of something else
        ASSERT_TRUE(rig.keepAlive());
    }
    EXPECT_GT(device.count(Op::Ping), before);
    EXPECT_LT(device.longestSilence, 2s);
}

TEST(Rig, ACaptureIsARangeOfItsFrames) {
    ScriptedRig device;
    Rig rig = configured(device);
    const auto capture = rig.capture(kRequest);
    ASSERT_TRUE(capture) << capture.error().message;
    std::size_t count = 0;
    for (const Frame& frame : *capture) EXPECT_EQ(&frame, &(*capture)[count++]);
    EXPECT_EQ(count, capture->size());
    EXPECT_EQ(&capture->front(), &(*capture)[0]);
}

}  // namespace
}  // namespace gonio::driver
