#include "sim/faults/faulty_usb.h"

#include <gtest/gtest.h>

#include "driver/protocol/chunk.h"
#include "driver/protocol/reports.h"

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;
using driver::Op;

constexpr std::size_t kRoom = 1U << 20;

/// A rig with a session, one frame of two chunks of pixels armed and taken.
class FaultyUsbTest : public testing::Test {
protected:
    void play(const std::string& text) {
        auto script = FaultScript::parse(text);
        ASSERT_TRUE(script) << script.error().message;
        usb.play(std::move(*script));
    }
    void send(Op op, const driver::Arguments& arguments) {
        const auto report = driver::encode(driver::Command{
            .sessionLow = 7, .sequence = ++sequence, .op = op, .arguments = arguments});
        usb.interruptOut(report);
    }
    void takeFrame() {
        if (sequence == 0) {
            usb.device().setFeature(driver::encode(driver::SessionSet{.sessionId = 7}));
            send(Op::SetFormat,
                 driver::encode(driver::SetFormat{.format = driver::PixelFormat::Mono16,
                                                  .x = 0,
                                                  .y = 0,
                                                  .width = 512,
                                                  .height = 512,
                                                  .binning = 1}));
        }
        send(Op::Arm, driver::encode(driver::Arm{.captureId = ++capture, .frames = 1}));
        usb.advanceTo(usb.now() + 1s);
    }
    std::vector<ChunkBytes> chunks() {
        std::vector<ChunkBytes> all;
        while (true) {
            UsbReply reply = usb.bulkIn(kRoom);
            if (reply.answer != UsbAnswer::Done) return all;
            all.push_back(std::move(reply.data));
        }
    }
    static driver::ChunkFault faultOf(const ChunkBytes& chunk) {
        return driver::checkChunk(chunk).fault;
    }

    FaultyUsb usb{{.errors = {}}};
    std::uint16_t sequence = 0;
    std::uint64_t capture = 0;
};

TEST_F(FaultyUsbTest, WithoutAScriptNothingIsWrong) {
    takeFrame();
    const auto all = chunks();
    ASSERT_EQ(all.size(), 4U);
    for (const ChunkBytes& chunk : all) EXPECT_EQ(faultOf(chunk), driver::ChunkFault::None);
}

TEST_F(FaultyUsbTest, ChunksAreLostDoubledAndSwapped) {
    play(
        "on chunk 1 of frame 1 lose chunk\n"
        "on chunk 2 of frame 2 duplicate chunk\n"
        "on chunk 1 of frame 3 swap chunks\n");
    takeFrame();
    EXPECT_EQ(chunks().size(), 3U);
    takeFrame();
    const auto doubled = chunks();
    ASSERT_EQ(doubled.size(), 5U);
    EXPECT_EQ(doubled[2], doubled[3]);
    takeFrame();
    const auto swapped = chunks();
    ASSERT_EQ(swapped.size(), 4U);
    EXPECT_EQ(driver::checkChunk(swapped[1]).chunk.header.chunkIndex, 2);
    EXPECT_EQ(driver::checkChunk(swapped[2]).chunk.header.chunkIndex, 1);
    EXPECT_EQ(usb.tally().of(FaultKind::SwapChunks), 1);
}

TEST_F(FaultyUsbTest, BitsFlipWhereTheyAreToldTo) {
    play(
        "on chunk 1 of frame 1 flip 1 bits in payload\n"
        "on chunk 2 of frame 1 flip 1 bits in header\n"
        "on chunk 1 of frame 2 burst of 32 bits in payload\n");
    takeFrame();
    const auto flipped = chunks();
    EXPECT_EQ(faultOf(flipped[1]), driver::ChunkFault::PayloadCrc);
    EXPECT_TRUE(faultOf(flipped[2]) == driver::ChunkFault::HeaderCrc ||
                faultOf(flipped[2]) == driver::ChunkFault::Magic);
    takeFrame();
    EXPECT_EQ(faultOf(chunks()[1]), driver::ChunkFault::PayloadCrc);
}

TEST_F(FaultyUsbTest, AStallLastsUntilItIsCleared) {
    play("on chunk 2 stall bulk\n");
    takeFrame();
    EXPECT_EQ(chunks().size(), 1U);
    EXPECT_EQ(usb.bulkIn(kRoom).answer, UsbAnswer::Stall);
    usb.control({.requestType = 2, .request = 1, .index = UsbDevice::kBulkIn});
    EXPECT_EQ(chunks().size(), 2U);  // one was half sent
}

TEST_F(FaultyUsbTest, APulledCableIsAnErrorThenNothingIsThere) {
    play("on chunk 2 unplug for 1s\n");
    takeFrame();
    EXPECT_EQ(usb.bulkIn(kRoom).answer, UsbAnswer::Done);
    EXPECT_EQ(usb.bulkIn(kRoom).answer, UsbAnswer::Error);
    EXPECT_EQ(usb.bulkIn(kRoom).answer, UsbAnswer::Gone);
    EXPECT_EQ(usb.control({.requestType = 0x80}).answer, UsbAnswer::Gone);
    EXPECT_EQ(usb.pulls(), 1);
    usb.advanceTo(usb.now() + 1s);
    EXPECT_TRUE(usb.plugged());
}

TEST_F(FaultyUsbTest, AHungRigNaksUntilItsPortIsReset) {
    play("at 0s hang until reset\n");
    EXPECT_EQ(usb.control({.requestType = 0x80, .length = 2}).answer, UsbAnswer::Nak);
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Nak);
    usb.resetPort();
    EXPECT_EQ(usb.control({.requestType = 0x80, .length = 2}).answer, UsbAnswer::Done);
}

TEST_F(FaultyUsbTest, SilentReportsAreNakAndLostStalledOnesWaitForTheHaltToBeCleared) {
    constexpr UsbSetup kClear{.requestType = 2, .request = 1, .index = usb::kInterruptIn};
    while (usb.interruptIn().answer == UsbAnswer::Done) {
    }
    play("at 0s silence reports\n");
    usb.device().tellUnknownEvent();
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Nak);
    usb.control(kClear);
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Nak) << "it was no stall";
    usb.reportsOpened();
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Nak) << "it was lost";
    play("at 0s stall reports\n");
    usb.device().tellUnknownEvent();
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Stall);
    usb.reportsOpened();
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Stall) << "its halt is still there";
    usb.control(kClear);
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Done);
    EXPECT_EQ(usb.reports().haltsCleared(), 1);
}

TEST_F(FaultyUsbTest, AStallThatLastsIsThereAgainAfterEachClearing) {
    constexpr UsbSetup kClear{.requestType = 2, .request = 1, .index = usb::kInterruptIn};
    play("at 0s stall reports for 400ms\n");
    usb.advanceTo(usb.now() + 399ms);
    usb.control(kClear);
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Stall);
    usb.advanceTo(usb.now() + 1ms);
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Stall);
    usb.control(kClear);
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Done);
}

TEST_F(FaultyUsbTest, OfReportsThatPileUpTheQueueKeepsSixtyThree) {
    while (usb.interruptIn().answer == UsbAnswer::Done) {
    }
    play("at 0s pile up 100 reports\n");
    int came = 0;
    while (usb.interruptIn().answer == UsbAnswer::Done) ++came;
    EXPECT_EQ(came, 63);
    EXPECT_EQ(usb.device().overflow().reports, 37);
}

TEST_F(FaultyUsbTest, ALateAckComesWhenItIsDue) {
    play("on command 1 delay ack 150ms\n");
    const auto acks = [&] {
        int count = 0;
        for (UsbReply reply = usb.interruptIn(); reply.answer == UsbAnswer::Done;
             reply = usb.interruptIn())
            count += reply.data[0] == static_cast<std::uint8_t>(driver::ReportId::Ack) ? 1 : 0;
        return count;
    };
    send(Op::Ping, {});
    EXPECT_EQ(acks(), 0);
    usb.advanceTo(usb.now() + 149ms);
    EXPECT_EQ(acks(), 0);
    usb.advanceTo(usb.now() + 1ms);
    EXPECT_EQ(acks(), 1);
}

TEST_F(FaultyUsbTest, AnotherRigHasAnotherSerialNumberAndKnowsNothing) {
    takeFrame();
    play("at 0s plug as SIM-0666 for 1s\n");
    EXPECT_EQ(usb.usb().device().serial(), "SIM-0666");
    EXPECT_EQ(chunks().size(), 0U);
    usb.advanceTo(usb.now() + 1s);
    EXPECT_EQ(usb.usb().device().serial(), "SIM-0001");
}

TEST_F(FaultyUsbTest, TheSameSeedSpoilsTheSameChunks) {
    const auto spoiled = [](std::uint64_t seed) {
        FaultScript script = FaultScript::parse("with chance 0.3 per chunk lose chunk\n").value();
        script.seed = seed;
        FaultPlayer player(script, Nanoseconds(0));
        std::string pattern;
        for (int i = 0; i < 64; ++i) pattern += player.chunkSent({}).empty() ? '.' : 'x';
        return pattern;
    };
    EXPECT_EQ(spoiled(3), spoiled(3));
    EXPECT_NE(spoiled(3), spoiled(4));
}

TEST_F(FaultyUsbTest, AFrameCanBeWellFormedAndWrong) {
    play("on frame 1 black frame\n");
    takeFrame();
    const auto black = chunks();
    for (std::size_t i = driver::kChunkHeaderBytes; i < black[1].size(); ++i)
        ASSERT_EQ(black[1][i], 0);
    EXPECT_EQ(faultOf(black[1]), driver::ChunkFault::None);
    takeFrame();
    EXPECT_NE(chunks()[1][driver::kChunkHeaderBytes], 0);
}

TEST_F(FaultyUsbTest, OfFaultsThatOverlapTheLastEndCounts) {
    play("at 4s unplug for 6s\nat 5s unplug for 1s\n");
    usb.advanceTo(9900ms);
    EXPECT_FALSE(usb.plugged());
    usb.advanceTo(10100ms);
    EXPECT_TRUE(usb.plugged());
    usb.advanceTo(20s);
    EXPECT_TRUE(usb.plugged());
    EXPECT_EQ(usb.pulls(), 1);
}

TEST_F(FaultyUsbTest, TheEndOfAHangThatIsOverEndsNoLaterOne) {
    play("at 1s hang for 2s\nat 1.5s end hang\nat 2s hang until reset\n");
    usb.advanceTo(1900ms);
    EXPECT_FALSE(usb.hung());
    usb.advanceTo(4s);
    EXPECT_TRUE(usb.hung());
    usb.resetPort();
    EXPECT_FALSE(usb.hung());
}

TEST_F(FaultyUsbTest, WhatAScriptHasBegunEndsUnderTheNextOne) {
    play("at 0s unplug for 1s\n");
    EXPECT_FALSE(usb.plugged());
    play("at 9s hang\n");
    usb.advanceTo(usb.now() + 1s);
    EXPECT_TRUE(usb.plugged());
}

TEST_F(FaultyUsbTest, PluggingInWhatIsPluggedInDoesNothing) {
    play("at 0s plug\n");
    EXPECT_EQ(usb.pulls(), 0);
}

TEST_F(FaultyUsbTest, AnAckOfBeforeDoesNotComeFromTheNextBoot) {
    play("on command 1 delay ack 150ms\n");
    send(Op::Ping, {});
    while (usb.interruptIn().answer == UsbAnswer::Done) {
    }
    play("at 0s lose power for 50ms\n");
    usb.advanceTo(usb.now() + 1s);
    ASSERT_TRUE(usb.plugged());
    for (UsbReply reply = usb.interruptIn(); reply.answer == UsbAnswer::Done;
         reply = usb.interruptIn())
        EXPECT_NE(reply.data[0], static_cast<std::uint8_t>(driver::ReportId::Ack));
}

TEST_F(FaultyUsbTest, AStalledEndpointOfReportsSpeaksOnceItsHaltIsCleared) {
    const auto halted = [&] {
        const UsbReply status = usb.control(
            {.requestType = 0x82, .request = 0, .index = usb::kInterruptIn, .length = 2});
        return status.data.at(0);
    };
    EXPECT_EQ(halted(), 0);
    play("at 0s stall reports\n");
    usb.advanceTo(usb.now() + 200ms);
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Stall);
    EXPECT_EQ(halted(), 1);
    usb.control({.requestType = 0x02, .request = 1, .index = usb::kInterruptIn});
    EXPECT_EQ(halted(), 0);
    usb.advanceTo(usb.now() + 200ms);
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Done);
}

TEST_F(FaultyUsbTest, AFlushDropsTheChunkThatIsHalfSent) {
    constexpr std::size_t kPacket = 512;
    takeFrame();
    EXPECT_LT(usb.bulkIn(kPacket).data.size(), kPacket) << "the LEADER";
    EXPECT_EQ(usb.bulkIn(kPacket).data.size(), kPacket) << "a part of the first DATA chunk";
    send(Op::Flush, {});
    EXPECT_EQ(usb.bulkIn(kPacket).answer, UsbAnswer::Nak);
}

TEST_F(FaultyUsbTest, AFlushThatIsRefusedDropsNothing) {
    play("on chunk 1 duplicate chunk\n");
    takeFrame();
    EXPECT_EQ(usb.bulkIn(kRoom).answer, UsbAnswer::Done);
    usb.interruptOut(driver::encode(
        driver::Command{.sessionLow = 8, .sequence = 1, .op = Op::Flush, .arguments = {}}));
    EXPECT_EQ(chunks().size(), 4U) << "the LEADER again, and what follows it";
}

TEST_F(FaultyUsbTest, ARigThatIsToldToRebootLeavesTheBusAndComesBackAsAnotherBoot) {
    const auto bootId = [&] {
        constexpr auto kIdent = static_cast<std::uint8_t>(driver::ReportId::Ident);
        return driver::decodeIdent(*usb.device().getFeature(kIdent)).value().bootId;
    };
    takeFrame();
    const auto boot = bootId();
    send(Op::Reboot, {});
    EXPECT_TRUE(usb.plugged()) << "the ACK is still to be read";
    usb.advanceTo(usb.now() + 100ms);
    EXPECT_FALSE(usb.plugged());
    usb.advanceTo(usb.now() + 3s);
    EXPECT_TRUE(usb.plugged());
    EXPECT_NE(bootId(), boot);
}

TEST_F(FaultyUsbTest, ALostLinkSaysWhetherTheCableWasPulled) {
    std::vector<std::uint32_t> causes;
    const auto read = [&] {
        for (UsbReply reply = usb.interruptIn(); reply.answer == UsbAnswer::Done;
             reply = usb.interruptIn()) {
            driver::Report report{};
            std::copy(reply.data.begin(), reply.data.end(), report.begin());
            const auto event = driver::decodeEvent(report);
            if (event && event->code == driver::event::kLinkLost) causes.push_back(event->arg0);
        }
    };
    usb.resetPort();
    read();
    usb.unplug();
    usb.plug();
    read();
    EXPECT_EQ(causes, (std::vector<std::uint32_t>{1, 3}));
}

TEST_F(FaultyUsbTest, AStringIsNoLongerThanItWasAskedFor) {
    constexpr UsbSetup kProtocol{.requestType = 0x80, .request = 6, .value = 0x03F0, .length = 4};
    EXPECT_EQ(usb.control(kProtocol).data.size(), 4U);
    play("at 0s newer minor\n");
    EXPECT_EQ(usb.control(kProtocol).data.size(), 4U);
}

}  // namespace
}  // namespace gonio::sim
