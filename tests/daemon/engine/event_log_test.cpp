#include "daemon/engine/event_log.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/wait_until.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;

EventRecord event(const std::string& type) { return {.dateUtc = "t", .type = type, .data = "{}"}; }

TEST(EventLog, NumbersGoOnAfterTheNewest) {
    EventLog log(41);
    EXPECT_EQ(log.newest(), 41U);
    EXPECT_EQ(log.oldest(), 42U);  // one more than newest: there is none
    EXPECT_EQ(log.add(event("a")).id, 42U);
    EXPECT_EQ(log.add(event("b")).id, 43U);
    EXPECT_EQ(log.oldest(), 42U);
    EXPECT_EQ(log.newest(), 43U);
}

TEST(EventLog, GivesWhatCameAfterANumberOldestFirst) {
    EventLog log(0);
    for (const char* type : {"a", "b", "c"}) log.add(event(type));
    const auto later = log.after(1, 0ms);
    ASSERT_EQ(later.size(), 2U);
    EXPECT_EQ(later[0].type, "b");
    EXPECT_EQ(later[1].type, "c");
    EXPECT_EQ(later[1].id, 3U);
    EXPECT_EQ(log.after(0, 0ms).size(), 3U);
    EXPECT_TRUE(log.after(3, 0ms).empty());
    EXPECT_TRUE(log.after(99, 0ms).empty()) << "a number that is yet to come";
}

TEST(EventLog, KeepsTheNewestFewThousand) {
    constexpr std::uint64_t kAdded = 6000;
    EventLog log(0);
    for (std::uint64_t i = 0; i < kAdded; ++i) log.add(event("x"));
    const auto kept = log.after(0, 0ms);
    EXPECT_EQ(kept.size(), 4096U);
    EXPECT_EQ(kept.front().id, log.oldest());
    EXPECT_EQ(kept.back().id, kAdded);
    for (std::size_t i = 1; i < kept.size(); ++i) ASSERT_EQ(kept[i].id, kept[i - 1].id + 1);
}

TEST(EventLog, WaitsNoLongerThanItWasTold) {
    EventLog log(0);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(log.after(0, 20ms).empty());
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);
}

TEST(EventLog, WaitEndsWithTheEvent) {
    EventLog log(0);
    std::vector<EventRecord> seen;
    std::jthread watcher([&] { seen = log.after(0, test::kPatience); });
    log.add(event("a"));
    watcher.join();
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_EQ(seen.front().type, "a");
}

TEST(EventLog, ClosingEndsEveryWait) {
    EventLog log(0);
    const auto begin = std::chrono::steady_clock::now();
    {
        std::vector<std::jthread> watchers;
        for (int i = 0; i < 4; ++i) {
            watchers.emplace_back([&] { (void)log.after(0, test::kPatience); });
        }
        log.close();
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, test::kPatience);
    EXPECT_TRUE(log.closed());
    EXPECT_TRUE(log.after(0, test::kPatience).empty()) << "nobody waits from now on";
}

TEST(EventLog, EveryWatcherSeesEveryEventOnceAndInOrder) {
    constexpr std::uint64_t kEvents = 2000;  // fewer than are kept: a slow watcher loses none
    EventLog log(0);
    std::vector<std::vector<std::uint64_t>> seen(3);
    {
        std::vector<std::jthread> watchers;
        for (auto& mine : seen) {
            watchers.emplace_back([&] {
                std::uint64_t after = 0;
                while (after < kEvents) {
                    const auto events = log.after(after, test::kPatience);
                    if (events.empty()) return;
                    for (const EventRecord& one : events) mine.push_back(one.id);
                    after = mine.back();
                }
            });
        }
        for (std::uint64_t i = 0; i < kEvents; ++i) log.add(event("x"));
    }
    for (const auto& mine : seen) {
        ASSERT_EQ(mine.size(), kEvents);
        for (std::uint64_t i = 0; i < kEvents; ++i) ASSERT_EQ(mine[i], i + 1);
    }
}

}  // namespace
}  // namespace gonio::daemon
