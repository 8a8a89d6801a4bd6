#include "sim/claim.h"

#include <gtest/gtest.h>

namespace gonio::sim {
namespace {

using namespace driver;

constexpr std::uint64_t kId = 0x1122334455667788;

Command ping(std::uint16_t sequence) {
    return {.sessionLow = static_cast<std::uint32_t>(kId), .sequence = sequence};
}

Claim claimed() {
    Claim claim;
    claim.renew({.sessionId = kId, .heartbeatMs = 500}, Nanoseconds(7));
    return claim;
}

TEST(Claim, WhoClaimsHasItAndAStrangerIsNotAnswered) {
    EXPECT_EQ(Claim().answerOf(ping(1))->ack.status, status::kNotOwner);
    const Claim claim = claimed();
    EXPECT_FALSE(claim.answerOf(ping(1)));  // to be done
    Command stranger = ping(1);
    ++stranger.sessionLow;
    EXPECT_EQ(claim.answerOf(stranger)->ack.status, status::kNotOwner);
    EXPECT_EQ(claim.state(0).sessionId, kId);
    EXPECT_EQ(claim.state(0).heartbeatMs, 500);
}

TEST(Claim, ACommandThatComesAgainIsAnsweredAgain) {
    Claim claim = claimed();
    const Ack done{.sequence = 1, .status = status::kBadArg, .sessionLow = ping(1).sessionLow};
    claim.keep(ping(1), done);
    const auto again = claim.answerOf(ping(1));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->ack, done);
    EXPECT_TRUE(again->replayed);
    Command other = ping(1);
    other.op = Op::Flush;
    EXPECT_EQ(claim.answerOf(other)->ack.status, status::kBadSeq);
    EXPECT_FALSE(claim.answerOf(other)->replayed);
}

TEST(Claim, TheLastEightAnswersAreKeptAlsoOverALapse) {
    Claim claim = claimed();
    EXPECT_EQ(claim.newest().sequence, 0);
    for (std::uint16_t i = 1; i <= 9; ++i) claim.keep(ping(i), {.sequence = i});
    EXPECT_EQ(claim.newest().sequence, 9);
    EXPECT_EQ(claim.lastCommand(), 9);
    claim.lapse();
    EXPECT_EQ(claim.answerOf(ping(9))->ack.status, status::kNotOwner);
    claim.renew({.sessionId = kId}, Nanoseconds(0));
    EXPECT_TRUE(claim.answerOf(ping(2))->replayed);
    EXPECT_EQ(claim.answerOf(ping(1))->ack.status, status::kBadSeq);  // the ninth before
}

TEST(Claim, SequenceNumbersWrapAndNeverGoBack) {
    Claim claim = claimed();
    claim.keep(ping(65535), {});
    EXPECT_FALSE(claim.answerOf(ping(1)));
    EXPECT_EQ(claim.answerOf(ping(0))->ack.status, status::kBadSeq);
    EXPECT_FALSE(claim.answerOf(ping(32766)));  // 32767 ahead
    EXPECT_EQ(claim.answerOf(ping(32767))->ack.status, status::kBadSeq);
}

TEST(Claim, LapsesItsHeartbeatAfterItWasFed) {
    Claim claim = claimed();
    EXPECT_EQ(claim.lapsesAt(), Nanoseconds(500'000'007));
    claim.feed(Nanoseconds(1'000));
    EXPECT_EQ(claim.lapsesAt(), Nanoseconds(500'001'000));
    EXPECT_EQ(claim.silence(Nanoseconds(1'500)), Nanoseconds(500));
}

}  // namespace
}  // namespace gonio::sim
