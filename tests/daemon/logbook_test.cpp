#include "daemon/logbook.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/support/error_kinds.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

class LogbookInStore : public testing::Test {
protected:
    void SetUp() override { reopen(); }
    void reopen() {
        book.reset();
        auto opened = Logbook::open(folder.path());
        ASSERT_TRUE(opened) << opened.error().message;
        book.emplace(std::move(*opened));
    }
    std::int64_t begin(const std::string& kind, const std::string& name = {}) {
        const auto job = book->beginJob({.kind = kind, .name = name, .startedUtc = "t0"});
        EXPECT_TRUE(job) << job.error().message;
        return job ? job->id : 0;
    }
    JobRecord job(std::int64_t id) {
        const auto found = book->job(id);
        EXPECT_TRUE(found) << found.error().message;
        return found ? *found : JobRecord{};
    }
    test::TempFolder folder;
    std::optional<Logbook> book;
};

TEST_F(LogbookInStore, BeginsEmpty) {
    EXPECT_EQ(*book->currentSession(), std::nullopt);
    EXPECT_TRUE(book->sessions()->empty());
    EXPECT_TRUE(book->jobs(10)->empty());
    EXPECT_TRUE(book->eventsAfter(0, 10)->empty());
    EXPECT_EQ(*book->newestEvent(), 0U);
    EXPECT_EQ(*book->setting("any"), "");
}

TEST_F(LogbookInStore, SessionIsOpenUntilItIsClosedAlsoOverARestart) {
    const auto opened = book->openSession(
        {.name = "one", .operatorName = "Ada", .notes = "warm", .openedUtc = "t1"});
    ASSERT_TRUE(opened) << opened.error().message;
    reopen();
    const auto current = book->currentSession();
    ASSERT_TRUE(current && *current);
    EXPECT_EQ((*current)->id, opened->id);
    EXPECT_EQ((*current)->operatorName, "Ada");
    EXPECT_EQ((*current)->notes, "warm");
    EXPECT_EQ((*current)->closedUtc, "");
    const auto closed = book->closeSession("t2");
    ASSERT_TRUE(closed) << closed.error().message;
    EXPECT_EQ(closed->closedUtc, "t2");
    EXPECT_EQ(*book->currentSession(), std::nullopt);
    EXPECT_EQ(book->sessions()->front().closedUtc, "t2");
}

TEST_F(LogbookInStore, OneSessionIsOpenAtATime) {
    ASSERT_TRUE(book->openSession({.name = "one", .openedUtc = "t1"}));
    const auto second = book->openSession({.name = "two", .openedUtc = "t2"});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, ErrorKind::Usage);
    EXPECT_NE(second.error().message.find("'one' is open"), std::string::npos);
    EXPECT_EQ(book->sessions()->size(), 1U);
}

TEST_F(LogbookInStore, SessionNameIsUsedOnce) {
    ASSERT_TRUE(book->openSession({.name = "one", .openedUtc = "t1"}));
    ASSERT_TRUE(book->closeSession("t2"));
    const auto again = book->openSession({.name = "one", .openedUtc = "t3"});
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().kind, ErrorKind::Usage);
    EXPECT_EQ(*book->currentSession(), std::nullopt);
}

TEST_F(LogbookInStore, SessionWithoutANameGetsItsDate) {
    const auto opened = book->openSession({.openedUtc = "2026-01-02T03:04:05Z"});
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(opened->name, "2026-01-02T03:04:05Z");
}

TEST_F(LogbookInStore, ClosingWithoutAnOpenSessionIsAUsageError) {
    const auto closed = book->closeSession("t");
    ASSERT_FALSE(closed);
    EXPECT_EQ(closed.error().kind, ErrorKind::Usage);
}

TEST_F(LogbookInStore, SessionsAreListedNewestFirst) {
    for (const std::string name : {"a", "b", "c"}) {
        ASSERT_TRUE(book->openSession({.name = name, .openedUtc = name}));
        ASSERT_TRUE(book->closeSession(name));
    }
    const auto sessions = book->sessions();
    ASSERT_EQ(sessions->size(), 3U);
    EXPECT_EQ(sessions->front().name, "c");
    EXPECT_EQ(sessions->back().name, "a");
}

TEST_F(LogbookInStore, JobKeepsHowItEnded) {
    const std::int64_t id = begin("measure", "tile");
    EXPECT_EQ(job(id).state, JobState::Running);
    EXPECT_EQ(job(id).endedUtc, "");
    EXPECT_FALSE(job(id).error);
    JobRecord done = job(id);
    done.state = JobState::Done;
    done.endedUtc = "t1";
    done.result = R"({"schema":"gonio/measure/1"})";
    ASSERT_TRUE(book->endJob(done));
    reopen();
    EXPECT_EQ(job(id).state, JobState::Done);
    EXPECT_EQ(job(id).name, "tile");
    EXPECT_EQ(job(id).startedUtc, "t0");
    EXPECT_EQ(job(id).endedUtc, "t1");
    EXPECT_EQ(job(id).result, done.result);
    EXPECT_FALSE(job(id).error);
}

TEST_F(LogbookInStore, EveryKindOfErrorComesBackWithItsJob) {
    for (const ErrorKind kind : test::kErrorKinds) {
        JobRecord failed = job(begin("measure"));
        failed.state = JobState::Failed;
        failed.error = Error{kind, "why"};
        ASSERT_TRUE(book->endJob(failed));
        const JobRecord back = job(failed.id);
        ASSERT_TRUE(back.error);
        EXPECT_EQ(back.error->kind, kind);
        EXPECT_EQ(back.error->message, "why");
    }
}

TEST_F(LogbookInStore, EveryStateComesBackWithItsJob) {
    for (const JobState state : {JobState::Running,
                                 JobState::Done,
                                 JobState::Failed,
                                 JobState::Cancelled,
                                 JobState::Interrupted}) {
        JobRecord record = job(begin("measure"));
        record.state = state;
        ASSERT_TRUE(book->endJob(record));
        EXPECT_EQ(job(record.id).state, state) << name(state);
    }
}

TEST_F(LogbookInStore, JobThatIsNotThereIsAUsageErrorThatNamesIt) {
    const auto none = book->job(7);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::Usage);
    EXPECT_NE(none.error().message.find("job 7"), std::string::npos);
}

TEST_F(LogbookInStore, JobsAreListedNewestFirstAndAtMostSoMany) {
    for (int i = 0; i < 5; ++i) begin("measure", "s" + std::to_string(i));
    const auto jobs = book->jobs(3);
    ASSERT_EQ(jobs->size(), 3U);
    EXPECT_EQ(jobs->front().name, "s4");
    EXPECT_EQ(jobs->back().name, "s2");
}

TEST_F(LogbookInStore, NumberOfAJobIsNeverGivenTwice) {
    const std::int64_t first = begin("measure");
    reopen();
    EXPECT_GT(begin("measure"), first);
}

TEST_F(LogbookInStore, RunningJobsAreInterruptedAndOthersLeftAlone) {
    JobRecord done = job(begin("calibrate-black"));
    done.state = JobState::Done;
    ASSERT_TRUE(book->endJob(done));
    const std::int64_t running = begin("measure", "tile");
    const auto interrupted = book->interruptJobs("t9");
    ASSERT_TRUE(interrupted) << interrupted.error().message;
    ASSERT_EQ(interrupted->size(), 1U);
    EXPECT_EQ(interrupted->front().id, running);
    EXPECT_EQ(job(running).state, JobState::Interrupted);
    EXPECT_EQ(job(running).endedUtc, "t9");
    ASSERT_TRUE(job(running).error);
    EXPECT_EQ(job(running).error->kind, ErrorKind::Interrupted);
    EXPECT_EQ(job(done.id).state, JobState::Done);
    EXPECT_TRUE(book->interruptJobs("t10")->empty());
}

TEST_F(LogbookInStore, EventsComeBackInOrderAfterANumber) {
    for (const std::uint64_t id : {2U, 5U, 9U}) {
        ASSERT_TRUE(book->addEvent({.id = id, .dateUtc = "t", .type = "rig", .data = "{}"}));
    }
    reopen();
    EXPECT_EQ(*book->newestEvent(), 9U);
    EXPECT_EQ(book->eventsAfter(0, 10)->size(), 3U);
    const auto later = book->eventsAfter(2, 10);
    ASSERT_EQ(later->size(), 2U);
    EXPECT_EQ(later->front().id, 5U);
    EXPECT_EQ(later->front().type, "rig");
    EXPECT_EQ(later->front().data, "{}");
    EXPECT_EQ(later->front().dateUtc, "t");
    EXPECT_EQ(book->eventsAfter(0, 2)->back().id, 5U);
    EXPECT_TRUE(book->eventsAfter(9, 10)->empty());
}

TEST_F(LogbookInStore, NumberOfAnEventIsTakenOnce) {
    const EventRecord event{.id = 1, .dateUtc = "t", .type = "rig", .data = "{}"};
    ASSERT_TRUE(book->addEvent(event));
    EXPECT_FALSE(book->addEvent(event));
}

TEST_F(LogbookInStore, NewestValueOfASettingCounts) {
    ASSERT_TRUE(book->set("claim/SIM-0001", "-7"));
    ASSERT_TRUE(book->set("claim/SIM-0001", "8"));
    ASSERT_TRUE(book->set("claim/SIM-0002", "9"));
    reopen();
    EXPECT_EQ(*book->setting("claim/SIM-0001"), "8");
    EXPECT_EQ(*book->setting("claim/SIM-0002"), "9");
}

TEST_F(LogbookInStore, TextIsNeverTakenForSql) {
    const std::string text = "'); DROP TABLE jobs; -- \xC3\xA9 \n ?";
    const auto opened =
        book->openSession({.name = text, .operatorName = text, .notes = text, .openedUtc = "t"});
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ((*book->currentSession())->notes, text);
    EXPECT_EQ((*book->currentSession())->name, text);
    EXPECT_TRUE(book->jobs(1));
}

TEST(Logbook, RefusesADatabaseThatIsNone) {
    const test::TempFolder folder;
    const auto book = Logbook::open(folder / "there/is/no/store");
    ASSERT_FALSE(book);
    EXPECT_NE(book.error().message.find("gonio.db"), std::string::npos);
}

TEST(Logbook, SessionsHaveNamesThatCanBePrinted) {
    EXPECT_TRUE(check(SessionRecord{.name = std::string(128, 'x')}));
    EXPECT_FALSE(check(SessionRecord{.name = std::string(129, 'x')}));
    EXPECT_FALSE(check(SessionRecord{.name = "two\nlines"}));
    EXPECT_FALSE(check(SessionRecord{.operatorName = "\x1B[2J"}));
    EXPECT_TRUE(check(SessionRecord{.name = "M\xC3\xBCller", .notes = "two\nlines"}));
    EXPECT_FALSE(check(SessionRecord{.notes = std::string(4097, 'x')}));
}

}  // namespace
}  // namespace gonio::daemon
