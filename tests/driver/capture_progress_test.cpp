#include "driver/capture_progress.h"

#include <gtest/gtest.h>

namespace gonio::driver {
namespace {

Frame frame(int index) {
    Frame f;
    f.index = index;
    return f;
}

CaptureProgress begun(int frames) {
    CaptureProgress progress(frames);
    progress.begin();
    return progress;
}

TEST(CaptureProgress, IsOverWhenEveryFrameIsThere) {
    CaptureProgress progress = begun(2);
    EXPECT_EQ(progress.toArm(), 2);
    progress.keep(frame(1));
    EXPECT_TRUE(progress.waits());
    EXPECT_EQ(progress.toArm(), 1) << "up to the last that is missing";
    progress.keep(frame(0));
    EXPECT_FALSE(progress.waits());
    EXPECT_EQ(progress.toArm(), 0);
    EXPECT_EQ(progress.takeFrames()[1].index, 1);
}

TEST(CaptureProgress, HopesAgainWithEachAttempt) {
    CaptureProgress progress = begun(2);
    progress.keep(frame(0));
    progress.giveUp(1, "chunk 3");
    EXPECT_FALSE(progress.waits());
    EXPECT_TRUE(progress.failed());
    progress.begin();
    EXPECT_FALSE(progress.waitsFor(0));
    EXPECT_TRUE(progress.waitsFor(1));
    EXPECT_FALSE(progress.failed());
    EXPECT_EQ(progress.evidence(), "frame 1: chunk 3");
}

TEST(CaptureProgress, ADiscardedFrameIsNoFailure) {
    CaptureProgress progress = begun(1);
    progress.discard(0);
    EXPECT_FALSE(progress.waits());
    EXPECT_FALSE(progress.failed());
    EXPECT_EQ(progress.toArm(), 1);
    EXPECT_EQ(progress.discarded, 1);
}

TEST(CaptureProgress, IsSoundUpToAFrameWithAllThoseBefore) {
    CaptureProgress progress = begun(3);
    EXPECT_TRUE(progress.soundUpTo(0));
    progress.keep(frame(1));
    EXPECT_FALSE(progress.soundUpTo(2));
    progress.keep(frame(0));
    EXPECT_TRUE(progress.soundUpTo(2));
    progress.giveUp(2, "");
    EXPECT_FALSE(progress.soundUpTo(2)) << "it will have to be taken again";
}

TEST(CaptureProgress, AsksForAFrameAgainSoOftenAndNoMore) {
    CaptureProgress progress = begun(2);
    EXPECT_TRUE(progress.mayAskAgain(0, 2));
    EXPECT_TRUE(progress.mayAskAgain(0, 2));
    EXPECT_FALSE(progress.mayAskAgain(0, 2));
    EXPECT_TRUE(progress.mayAskAgain(1, 2));
    EXPECT_EQ(progress.resends, 3);
    progress.begin();
    EXPECT_TRUE(progress.mayAskAgain(0, 2));
}

TEST(CaptureProgress, KeepsTheFirstEightReasons) {
    CaptureProgress progress = begun(1);
    for (int i = 0; i < 20; ++i) progress.giveUp(0, std::to_string(i));
    EXPECT_TRUE(progress.evidence().ends_with("frame 0: 7"));
}

}  // namespace
}  // namespace gonio::driver
