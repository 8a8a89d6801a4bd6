#pragma once
// What happened in a laboratory, kept in the store's gonio.db: sessions (of people, not of USB),
// jobs and how they ended, events, and what the daemon has to remember over a restart. Each call is
// one transaction: once it has returned, it survives kill -9 and power loss.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/database.h"

namespace gonio::daemon {

struct SessionRecord {
    std::int64_t id = 0;
    std::string name;
    std::string operatorName;
    std::string notes;
    std::string openedUtc;
    std::string closedUtc;  ///< empty: still open
};

/// Usage error for a name or operator of more than 128 bytes or with control characters, and for
/// notes of more than 4096 bytes.
[[nodiscard]] Result<void> check(const SessionRecord& session);

/// Where a job stands. What was running when a daemon ended is found Interrupted by the next.
enum class JobState {
    Running,
    Done,
    Failed,
    Cancelled,
    Interrupted
};
[[nodiscard]] std::string_view name(JobState state);

struct JobRecord {
    std::int64_t id = 0;
    std::string kind;  ///< "measure", "calibrate-white", ...
    std::string name;  ///< of the sample; empty for others
    JobState state = JobState::Running;
    std::string startedUtc;
    std::string endedUtc;        ///< empty: still running
    std::optional<Error> error;  ///< why it did not end Done
    std::string result;          ///< the document that came of it, JSON
};

/// What a person calls it: "measure metal".
[[nodiscard]] std::string titleOf(const JobRecord& job);

struct EventRecord {
    std::uint64_t id = 0;  ///< ascending, also over restarts
    std::string dateUtc;
    std::string type;
    std::string data;  ///< JSON
};

class Logbook {
public:
    /// The store at `root` is there.
    [[nodiscard]] static Result<Logbook> open(const std::filesystem::path& root);
    /// For those who only look. File error when there is no store.
    [[nodiscard]] static Result<Logbook> openToRead(const std::filesystem::path& root);

    /// Usage error when one is open, or when there was one of that name. Without a name it gets its
    /// date's.
    Result<SessionRecord> openSession(SessionRecord session);
    /// Usage error when none is open.
    Result<SessionRecord> closeSession(const std::string& dateUtc);
    [[nodiscard]] Result<std::optional<SessionRecord>> currentSession();
    /// Newest first.
    [[nodiscard]] Result<std::vector<SessionRecord>> sessions();

    /// With its number.
    Result<JobRecord> beginJob(JobRecord job);
    Result<void> endJob(const JobRecord& job);
    /// Running ones become Interrupted; those.
    Result<std::vector<JobRecord>> interruptJobs(const std::string& dateUtc);
    /// Usage error when there is none of that number.
    [[nodiscard]] Result<JobRecord> job(std::int64_t id);
    /// Newest first, at most `count`.
    [[nodiscard]] Result<std::vector<JobRecord>> jobs(int count);

    Result<void> addEvent(const EventRecord& event);
    /// Those after number `id`, oldest first, at most `count`.
    [[nodiscard]] Result<std::vector<EventRecord>> eventsAfter(std::uint64_t id, int count);
    /// 0: there is none.
    [[nodiscard]] Result<std::uint64_t> newestEvent();

    /// Empty: never set.
    [[nodiscard]] Result<std::string> setting(const std::string& name);
    Result<void> set(const std::string& name, const std::string& value);

private:
    explicit Logbook(Database database) : database_(std::move(database)) {}
    Database database_;
};

}  // namespace gonio::daemon
