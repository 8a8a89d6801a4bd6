#include "daemon/cli/event_stream.h"

#include <gtest/gtest.h>

namespace gonio::daemon {
namespace {

TEST(EventStream, GivesAnEventWhenItsEmptyLineComes) {
    EventStream stream;
    EXPECT_TRUE(stream.feed("id: 7\nevent: job\ndata: {\"job\":1}\n").empty());
    const auto events = stream.feed("\n");
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].id, 7U);
    EXPECT_EQ(events[0].type, "job");
    EXPECT_EQ(events[0].data, "{\"job\":1}");
}

TEST(EventStream, GivesAllThatTheBytesComplete) {
    EventStream stream;
    const auto events = stream.feed("id: 1\ndata: a\n\nid: 2\ndata: b\n\nid: 3\ndata: c\n");
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(events[0].id, 1U);
    EXPECT_EQ(events[1].data, "b");
}

TEST(EventStream, SkipsCommentsUnknownFieldsAndEventsWithoutData) {
    EventStream stream;
    EXPECT_TRUE(stream.feed(":\n\n: tick\n\nretry: 5\nnonsense\nid: 4\nevent: x\n\n").empty());
    const auto events = stream.feed(":c\ncolour: red\ndata: a\n\n");
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].type, "") << "of this event alone";
    EXPECT_EQ(events[0].data, "a");
}

TEST(EventStream, TakesOneSpaceAfterTheColonAway) {
    EventStream stream;
    EXPECT_EQ(stream.feed("data:a\n\n").at(0).data, "a");
    EXPECT_EQ(stream.feed("data:  a\n\n").at(0).data, " a");
    EXPECT_EQ(stream.feed("data: a: b\n\n").at(0).data, "a: b");
}

TEST(EventStream, JoinsLinesOfData) {
    EventStream stream;
    EXPECT_EQ(stream.feed("data: a\ndata: b\n\n").at(0).data, "a\nb");
}

TEST(EventStream, NumberThatIsNoneIs0) {
    EventStream stream;
    EXPECT_EQ(stream.feed("id: x\ndata: a\n\n").at(0).id, 0U);
    EXPECT_EQ(stream.feed("id: -3\ndata: a\n\n").at(0).id, 0U);
    EXPECT_EQ(stream.feed("id: 9223372036854775807\ndata: a\n\n").at(0).id, 9223372036854775807U);
    EXPECT_EQ(stream.feed("id: 9223372036854775808\ndata: a\n\n").at(0).id, 0U);
}

TEST(EventStream, TakesLinesThatEndWithCarriageReturnToo) {
    EventStream stream;
    const auto events = stream.feed("id: 1\r\nevent: job\r\ndata: a\r\n\r\n");
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].type, "job");
    EXPECT_EQ(events[0].data, "a");
}

}  // namespace
}  // namespace gonio::daemon
