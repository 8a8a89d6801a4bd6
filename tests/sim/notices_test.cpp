#include "sim/notices.h"

#include <gtest/gtest.h>

namespace gonio::sim {
namespace {

using namespace driver;

int taken(Notices& notices) {
    int count = 0;
    while (notices.take()) ++count;
    return count;
}

TEST(Notices, ReportsComeInTheOrderInWhichTheyWereSaid) {
    Notices notices;
    EXPECT_FALSE(notices.take());
    notices.raise({.code = event::kBoot, .arg0 = 5}, 1000);
    notices.answer({.sequence = 3});
    notices.tell({.sequence = 9});
    const auto first = decodeEvent(*notices.take());
    ASSERT_TRUE(first);
    EXPECT_EQ(first->sequence, 1U);
    EXPECT_EQ(first->timeUs, 1000U);
    EXPECT_EQ(first->arg0, 5U);
    EXPECT_EQ(decodeAck(*notices.take())->sequence, 3);
    EXPECT_EQ(decodeStatus(*notices.take())->sequence, 9);
    EXPECT_FALSE(notices.take());
}

TEST(Notices, AStatusThatDoesNotFitTheHostsQueueIsLost) {
    Notices notices;
    for (int i = 0; i < 100; ++i) notices.tell({});
    EXPECT_EQ(taken(notices), 63);
}

TEST(Notices, TheLast64EventsCanBeReadAgainTwoAtATime) {
    Notices notices;
    EXPECT_EQ(notices.page().oldest, 0U);
    for (int i = 0; i < 70; ++i) notices.raise({.code = event::kClaimed}, 0);
    taken(notices);
    EXPECT_EQ(notices.newestEvent(), 70U);
    EXPECT_EQ(notices.page().oldest, 7U);
    EXPECT_EQ(notices.page().newest, 70U);
    notices.readEventsFrom(69);
    ASSERT_EQ(notices.page().events.size(), 2U);
    EXPECT_EQ(notices.page().events[0].sequence, 69U);
    notices.readEventsFrom(70);
    EXPECT_EQ(notices.page().events.size(), 1U);
}

}  // namespace
}  // namespace gonio::sim
