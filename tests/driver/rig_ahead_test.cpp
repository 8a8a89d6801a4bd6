// Captures that are armed while the one before them is still sent.

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

std::vector<Op> operations(const ScriptedRig& device, std::size_t from = 0) {
    std::vector<Op> list;
    for (std::size_t i = from; i < device.log.size(); ++i) list.push_back(device.log[i].op);
    return list;
}

/// Counts the sends of each ARM and RESEND, and changes those of one of them.
auto at(int send, std::function<void(std::vector<Bytes>&)> change) {
    return [send, change](std::vector<Bytes>& chunks) mutable {
        if (send-- == 0) change(chunks);
    };
}

TEST(Rig, ArmsTheNextCaptureAsSoonAsTheLastFrameIsExposed) {
    ScriptedRig device;
    Rig rig = configured(device);
    std::vector<std::size_t> unread;
    device.onStream = [&](std::vector<Bytes>&) { unread.push_back(device.stream.size()); };
    const std::size_t from = device.log.size();
    expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
    const std::vector<Op> serial{Op::SetLed, Op::SetExposure, Op::Arm};
    std::vector<Op> both = serial;
    both.insert(both.end(), serial.begin(), serial.end());
    EXPECT_EQ(operations(device, from), both);
    EXPECT_EQ(unread, (std::vector<std::size_t>{0, kChunks - 1})) << "all but the LEADER";
    expectUndisturbed(rig.capture(kNext), kNext);
    EXPECT_EQ(operations(device, from), both) << "nothing more was needed";
    EXPECT_EQ(rig.anomalies(), Anomalies{});
}

TEST(Rig, EachCaptureMayArmTheNext) {
    ScriptedRig device;
    Rig rig = configured(device);
    CaptureRequest request = kRequest;
    for (int i = 0; i < 20; ++i) {
        CaptureRequest next = request;
        ++next.planStep;
        const auto capture = rig.capture(request, {next});
        ASSERT_TRUE(capture) << capture.error().message;
        EXPECT_EQ(capture->front().captureId, request.planStep << 16 | 1);
        request = next;
    }
    EXPECT_EQ(device.count(Op::Arm), 21);
    EXPECT_EQ(device.count(Op::Abort), 0);
    EXPECT_EQ(rig.anomalies(), Anomalies{});
}

TEST(Rig, LostChunkOfACaptureWithTheNextArmedIsRepaired) {
    for (std::size_t lost = 0; lost < 3 * kChunks; ++lost) {
        ScriptedRig device;
        Rig rig = configured(device);
        device.onStream = first(1, drop(lost));
        const auto capture = rig.capture(kRequest, {kNext});
        expectUndisturbed(capture, kRequest);
        EXPECT_EQ(capture->resends, 1) << lost;
        expectUndisturbed(rig.capture(kNext), kNext);
        EXPECT_EQ(device.count(Op::Arm), 2) << lost;
        EXPECT_EQ(device.count(Op::Abort), 0);
    }
}

TEST(Rig, LostChunkOfACaptureArmedAheadIsRepaired) {
    for (std::size_t lost = 0; lost < 2 * kChunks; ++lost) {
        ScriptedRig device;
        Rig rig = configured(device);
        device.onStream = at(1, drop(lost));
        expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
        const auto next = rig.capture(kNext);
        expectUndisturbed(next, kNext);
        EXPECT_EQ(next->resends, 1) << lost;
        EXPECT_EQ(device.count(Op::Arm), 2) << lost;
    }
}

TEST(Rig, CaptureArmedAheadShowsThatTheLastFrameIsLostWithoutWaiting) {
    ScriptedRig device;
    Rig rig = configured(device);
    // Of the last frame the LEADER comes, then the next capture's.
    device.onStream = first(1, [](std::vector<Bytes>& chunks) { chunks.resize(2 * kChunks + 1); });
    const Nanoseconds begin = device.clock().now();
    expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
    EXPECT_LT(device.clock().now() - begin, 100ms);
    expectUndisturbed(rig.capture(kNext), kNext);
}

TEST(Rig, RecaptureWithTheNextArmedTakesBothAgain) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.refuse[Op::Resend] = status::kFrameGone;
    device.onStream = first(1, drop(2 * kChunks + 3));
    const auto capture = rig.capture(kRequest, {kNext});
    expectUndisturbed(capture, kRequest);
    EXPECT_EQ(capture->recaptures, 1);
    EXPECT_EQ((*capture)[2].captureId, 0x50002U);
    const auto next = rig.capture(kNext);
    expectUndisturbed(next, kNext);
    EXPECT_EQ(next->front().captureId, 0x60002U) << "nothing of the first arming is used";
    EXPECT_EQ(device.count(Op::Arm), 4);
}

TEST(Rig, NothingIsArmedAheadOfACaptureThatHasToBeTakenAgain) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onFrame = [](FrameToSend& frame) {
        if (frame.leader.frameNumber == 1) frame.leader.led = 3;
    };
    expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
    EXPECT_EQ(device.count(Op::Arm), 3) << "the request twice, the next once";
}

TEST(Rig, OtherRequestThanTheOneArmedAheadIsTakenSerially) {
    ScriptedRig device;
    Rig rig = configured(device);
    CaptureRequest other = kNext;
    other.levels = LedLevels::only(Band::G, 30000);
    expectUndisturbed(rig.capture(kRequest, {other}), kRequest);
    const std::size_t from = device.log.size();
    const auto capture = rig.capture(kNext);
    expectUndisturbed(capture, kNext);
    EXPECT_EQ(capture->front().captureId, 0x60002U);
    EXPECT_EQ(operations(device, from),
              (std::vector<Op>{Op::Abort, Op::Flush, Op::SetLed, Op::SetExposure, Op::Arm}));
    EXPECT_EQ(rig.anomalies(), Anomalies{}) << "flushed, not lost";
}

TEST(Rig, WhatIsNotWantedAnyMoreIsAborted) {
    const auto after = [](auto call) {
        ScriptedRig device;
        Rig rig = configured(device);
        EXPECT_TRUE(rig.capture(kRequest, {kNext}));
        const std::size_t from = device.log.size();
        call(rig);
        EXPECT_EQ(device.led.levels, (std::array<std::uint16_t, 3>{}));
        EXPECT_TRUE(device.stream.empty());
        return operations(device, from);
    };
    EXPECT_EQ(after([](Rig& rig) { EXPECT_TRUE(rig.darken()); }),
              (std::vector<Op>{Op::Abort, Op::Flush, Op::SetLed}));
    EXPECT_EQ(after([](Rig& rig) { EXPECT_TRUE(rig.close()); }),
              (std::vector<Op>{Op::Abort, Op::Flush, Op::SetLed}));
    EXPECT_EQ(after([](Rig& rig) { EXPECT_TRUE(rig.configure(kWindow)); }),
              (std::vector<Op>{Op::Abort, Op::Flush, Op::SetFormat}));
    EXPECT_EQ(after([](Rig& rig) { EXPECT_FALSE(rig.capture({.frames = 99})); }),
              (std::vector<Op>{Op::Abort, Op::Flush}));
}

TEST(Rig, CapturesSeriallyAfterWhatWasArmedAheadIsAborted) {
    ScriptedRig device;
    Rig rig = configured(device);
    ASSERT_TRUE(rig.capture(kRequest, {kNext}));
    ASSERT_TRUE(rig.darken());
    expectUndisturbed(rig.capture(kNext), kNext);
    EXPECT_EQ(device.count(Op::Arm), 3);
}

TEST(Rig, WhatTheRigRefusesAheadIsSaidByItsOwnCapture) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = first(1, [&](std::vector<Bytes>&) {
        device.refuse[Op::SetLed] = status::kInterlock;  // opened while it exposes
    });
    expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
    const auto next = rig.capture(kNext);
    ASSERT_FALSE(next);
    EXPECT_EQ(next.error().deviceStatus, status::kInterlock);
    EXPECT_EQ(device.led.levels, (std::array<std::uint16_t, 3>{}));
}

TEST(Rig, RigThatIsNotIdleYetIsArmedSerially) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = at(0, [&](std::vector<Bytes>&) {
        device.refuse[Op::Arm] = status::kBadState;  // it still reads its sensor out
    });
    expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
    device.refuse.clear();
    expectUndisturbed(rig.capture(kNext), kNext);
    EXPECT_EQ(device.count(Op::Abort), 0);
}

TEST(Rig, SilenceWhileArmingAheadIsAnErrorWithinItsDeadline) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = first(1, [&](std::vector<Bytes>&) { device.deaf = true; });
    const auto capture = rig.capture(kRequest, {kNext});
    ASSERT_FALSE(capture);
    EXPECT_TRUE(mentions(capture.error(), "armed ahead, capture step 6 (LED 1"))
        << capture.error().message;
    EXPECT_TRUE(mentions(capture.error(), "no ACK"));
    EXPECT_LE(device.clock().now(), 2s);
}

TEST(Rig, AbortedFrameOfACaptureArmedAheadIsItsOwnError) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = at(1, [](std::vector<Bytes>& chunks) {
        ChunkHeader header = decodeChunk(chunks[0])->header;
        header.type = ChunkType::Aborted;
        header.chunkCount = 0;
        const Aborted why{.reason = status::kInterlock, .frameNumber = 4};
        chunks = {encodeChunk(header, encode(why))};
    });
    expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
    const auto next = rig.capture(kNext);
    ASSERT_FALSE(next);
    EXPECT_EQ(next.error().deviceStatus, status::kInterlock);
}

TEST(Rig, EarlyFramesOfACaptureArmedAheadAreReplaced) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.onStream = at(0, [&](std::vector<Bytes>&) { device.latency = 2; });
    device.onFrame = [](FrameToSend& frame) {
        const bool early = frame.leader.frameNumber == 4 || frame.leader.frameNumber == 5;
        if (early) frame.leader.led = 2;  // still the present capture's
    };
    expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
    const auto next = rig.capture(kNext);
    expectUndisturbed(next, kNext);
    EXPECT_EQ(next->discarded, 2);
}

TEST(Rig, NothingIsArmedAheadOfTheDark) {
    ScriptedRig device;
    Rig rig = configured(device);
    CaptureRequest last = kRequest;
    last.keepLit = false;
    EXPECT_TRUE(rig.capture(last, {kNext}));
    EXPECT_EQ(device.led, SetLed{});
    EXPECT_EQ(device.count(Op::Arm), 1);
    EXPECT_EQ(device.count(Op::Abort), 0);
}

TEST(Rig, RigThatKeepsFewFramesIsArmedSerially) {
    for (const std::uint16_t kept : {std::uint16_t{2}, std::uint16_t{3}}) {
        ScriptedRig device;
        device.ident.frameRam = kept;
        Rig rig = configured(device);
        expectUndisturbed(rig.capture(kRequest, {kNext}), kRequest);
        EXPECT_EQ(device.count(Op::Arm), kept == 2 ? 1 : 2);
        expectUndisturbed(rig.capture(kNext), kNext);
    }
}

TEST(Rig, RefusesANextRequestOutOfItsDomain) {
    ScriptedRig device;
    Rig rig = configured(device);
    CaptureRequest next = kNext;
    next.led = 4;
    const std::size_t from = device.log.size();
    const auto capture = rig.capture(kRequest, {next});
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().kind, ErrorKind::Usage);
    EXPECT_TRUE(mentions(capture.error(), "armed ahead")) << capture.error().message;
    EXPECT_EQ(device.log.size(), from) << "nothing was sent";
}

TEST(Rig, AnErrorWithTheNextArmedLeavesTheLedsDark) {
    ScriptedRig device;
    Rig rig = configured(device);
    device.refuse[Op::Resend] = status::kInternal;
    device.onStream = first(1, drop(2 * kChunks + 3));
    ASSERT_FALSE(rig.capture(kRequest, {kNext}));
    EXPECT_EQ(device.count(Op::Arm), 2);
    EXPECT_EQ(device.led.levels, (std::array<std::uint16_t, 3>{}));
    device.refuse.clear();
    expectUndisturbed(rig.capture(kNext), kNext);
}

}  // namespace
}  // namespace gonio::driver
