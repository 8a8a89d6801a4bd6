#include "sim/frame_queue.h"

#include <gtest/gtest.h>

#include "sim/frame_chunks.h"

namespace gonio::sim {
namespace {

using namespace driver;

/// A frame of one DATA chunk: LEADER, DATA, TRAILER.
FrameQueue::Frame frameOf(std::uint64_t capture, int index = 0) {
    const std::vector<std::uint8_t> pixels(16);
    return {.capture = capture,
            .index = index,
            .chunks = frameChunks({.captureId = capture}, {}, pixels, {})};
}

ChunkHeader headerOf(FrameQueue& queue) {
    const auto chunk = queue.take();
    EXPECT_TRUE(chunk);
    return decodeChunk(*chunk).value().header;
}

TEST(FrameQueue, ChunksAreNumberedInTheOrderInWhichTheyWereQueued) {
    FrameQueue queue;
    EXPECT_FALSE(queue.take());
    queue.add(frameOf(1));
    EXPECT_EQ(queue.framesWaiting(), 1U);
    for (std::uint32_t i = 1; i <= 3; ++i) EXPECT_EQ(headerOf(queue).streamSequence, i);
    EXPECT_EQ(queue.framesWaiting(), 0U);
    EXPECT_EQ(queue.nextSequence(), 4U);
}

TEST(FrameQueue, SendsAgainWhatItHolds) {
    FrameQueue queue;
    queue.add(frameOf(1));
    queue.flush();
    const auto whole = queue.resend({.captureId = 1, .frame = 0});
    EXPECT_EQ(whole.status, status::kOk);
    EXPECT_EQ(whole.chunks, 3U);
    queue.flush();
    EXPECT_EQ(queue.resend({.captureId = 1, .frame = 0, .firstChunk = 1, .lastChunk = 1}).chunks,
              1U);
    const ChunkHeader again = headerOf(queue);
    EXPECT_EQ(again.type, ChunkType::Data);
    EXPECT_TRUE(again.resent);
    EXPECT_EQ(again.streamSequence, 7U);
}

TEST(FrameQueue, RefusesWhatItDoesNotHold) {
    FrameQueue queue;
    queue.add(frameOf(1));
    EXPECT_EQ(queue.resend({.captureId = 2, .frame = 0}).status, status::kFrameGone);
    EXPECT_EQ(queue.resend({.captureId = 1, .frame = 1}).status, status::kFrameGone);
    const auto range = queue.resend({.captureId = 1, .frame = 0, .firstChunk = 2, .lastChunk = 3});
    EXPECT_EQ(range.status, status::kBadRange);
    EXPECT_EQ(range.chunks, 0U);
}

TEST(FrameQueue, TheOldestFrameIsForgotten) {
    FrameQueue queue;
    for (std::uint64_t capture = 1; capture <= kFrameRam; ++capture) queue.add(frameOf(capture));
    EXPECT_TRUE(queue.holds(1));
    queue.add(frameOf(kFrameRam + 1));
    EXPECT_FALSE(queue.holds(1));
    EXPECT_TRUE(queue.holds(2));
    queue.forgetFrames();
    EXPECT_FALSE(queue.holds(2));
}

TEST(FrameQueue, NoMoreWaitsToBeSentAgainThanTheFrameRamHasRoomFor) {
    FrameQueue queue;
    queue.add(frameOf(1));
    queue.flush();
    const Resend whole{.captureId = 1, .frame = 0};
    for (std::size_t i = 0; i < kFrameRam; ++i) EXPECT_EQ(queue.resend(whole).status, status::kOk);
    EXPECT_EQ(queue.resend(whole).status, status::kBusy);
    for (int i = 0; i < 3; ++i) (void)headerOf(queue);
    EXPECT_EQ(queue.resend(whole).status, status::kOk);
    EXPECT_EQ(queue.resend(whole).status, status::kBusy);
    queue.flush();
    EXPECT_EQ(queue.resend(whole).status, status::kOk);
}

}  // namespace
}  // namespace gonio::sim
