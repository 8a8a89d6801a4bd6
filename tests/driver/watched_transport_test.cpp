// Whether a rig is still there, judged as PROTOCOL.md 4 says.

#include "driver/watched_transport.h"

#include <gtest/gtest.h>

#include "tests/driver/loose_cable.h"
#include "tests/driver/scripted_rig.h"

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;
using namespace test;

class Watched : public testing::Test {
protected:
    Watched() { wire.watch(rig.ident.bootId); }

    ScriptedRig rig;
    LooseCable cable{rig, [] {}};
    WatchedTransport wire{cable};
};

TEST_F(Watched, AFailureWhileTheRigAnswersStandsForItself) {
    EXPECT_FALSE(wire.getFeature(99));
    EXPECT_FALSE(wire.lost());
    EXPECT_TRUE(wire.getFeature(1));
    EXPECT_EQ(cable.resets, 0);
}

TEST_F(Watched, AFailureOfTheProbeTooIsALossWithOneResetOfThePort) {
    cable.breaksAt = cable.calls;
    EXPECT_FALSE(wire.readBulk(1s));
    ASSERT_TRUE(wire.lost());
    EXPECT_EQ(cable.resets, 1);
    cable.over = true;
    EXPECT_FALSE(wire.readBulk(1s));
    EXPECT_FALSE(wire.readInput(1s));
    EXPECT_FALSE(wire.write({}));
    EXPECT_EQ(cable.touches, 0);
}

TEST_F(Watched, SilentReportsAreNoticedIn300MsAndOpenedAnew) {
    ASSERT_TRUE(wire.readInput(200ms));
    rig.mute = true;
    const Nanoseconds begin = wire.clock().now();
    while (wire.reopens() == 0 && wire.clock().now() - begin < 2s) {
        ASSERT_TRUE(wire.readInput(0ns));
        ASSERT_TRUE(wire.readBulk(10s)) << "the stream flows on";
    }
    EXPECT_EQ(wire.reopens(), 1U);
    EXPECT_LE(wire.clock().now() - begin, 600ms);
    rig.mute = false;
    ASSERT_TRUE(wire.readInput(200ms));
    EXPECT_FALSE(wire.lost());
}

TEST_F(Watched, ReportsThatStaySilentAreALoss) {
    rig.mute = true;
    const Nanoseconds begin = wire.clock().now();
    EXPECT_FALSE(wire.readInput(10s));
    ASSERT_TRUE(wire.lost());
    EXPECT_NE(wire.lost()->message.find("stay silent"), std::string::npos);
    EXPECT_EQ(wire.clock().now() - begin, 900ms);
    EXPECT_EQ(cable.reopens, 2);
    EXPECT_EQ(cable.resets, 1);
}

TEST_F(Watched, ReportsThatAreSilentForAMomentCountAfreshEachTime) {
    for (int i = 0; i < 10; ++i) {
        rig.mute = true;
        ASSERT_TRUE(wire.readInput(400ms));
        rig.mute = false;
        ASSERT_TRUE(wire.readInput(200ms));
    }
    EXPECT_EQ(wire.reopens(), 10U);
    EXPECT_FALSE(wire.lost());
}

TEST_F(Watched, ACallerWhoWasAwayFindsTheReportsThatWaited) {
    rig.pass(20s);
    ASSERT_TRUE(wire.readInput(0ns));
    EXPECT_EQ(wire.reopens(), 0U);
}

TEST_F(Watched, AnotherBootIsALossAndNothingIsReset) {
    ++rig.ident.bootId;
    EXPECT_FALSE(wire.getFeature(99));
    ASSERT_TRUE(wire.lost());
    EXPECT_NE(wire.lost()->message.find("rebooted"), std::string::npos);
    EXPECT_EQ(cable.resets, 0);
}

/// Its clock goes on at each look, as real ones do.
class Restless : public LooseCable, private Clock {
public:
    using LooseCable::LooseCable;
    Nanoseconds shortest = 1h;  ///< of the waits that were asked for

    [[nodiscard]] const Clock& clock() const override { return *this; }
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override {
        shortest = std::min(shortest, wait);
        return LooseCable::readInput(wait);
    }

private:
    [[nodiscard]] Nanoseconds now() const override { return now_ += 1us; }
    mutable Nanoseconds now_{0};
};

TEST(WatchedOnARealClock, NoWaitIsNegative) {
    ScriptedRig rig;
    Restless cable(rig, [] {});
    WatchedTransport wire(cable);
    wire.watch(rig.ident.bootId);
    for (const Nanoseconds wait : {0ns, 500ns, 5000ns}) EXPECT_TRUE(wire.readInput(wait));
    EXPECT_GE(cable.shortest, 0ns);
}

TEST(WatchedBefore, NothingIsJudged) {
    ScriptedRig rig;
    rig.mute = true;
    LooseCable cable(rig, [] {});
    WatchedTransport wire(cable);
    EXPECT_TRUE(wire.readInput(10s));
    EXPECT_FALSE(wire.getFeature(99));
    EXPECT_FALSE(wire.lost());
    EXPECT_EQ(cable.reopens + cable.resets, 0);
}

}  // namespace
}  // namespace gonio::driver
