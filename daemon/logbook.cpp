#include "daemon/logbook.h"

#include <algorithm>
#include <array>

#include "daemon/problem.h"
#include "daemon/store_schema.h"

namespace gonio::daemon {
namespace {

constexpr std::array<std::string_view, 5> kStates{
    "running", "done", "failed", "cancelled", "interrupted"};

JobState stateNamed(std::string_view text) {
    for (std::size_t i = 0; i < kStates.size(); ++i) {
        if (kStates[i] == text) return static_cast<JobState>(i);
    }
    return JobState::Failed;
}

SqlValue orNull(const std::string& text) {
    return text.empty() ? SqlValue(std::monostate{}) : SqlValue(text);
}

SessionRecord sessionOf(const SqlRow& row) {
    return {.id = integerOf(row[0]),
            .name = textOf(row[1]),
            .operatorName = textOf(row[2]),
            .notes = textOf(row[3]),
            .openedUtc = textOf(row[4]),
            .closedUtc = textOf(row[5])};
}
constexpr std::string_view kSessions =
    "SELECT id, name, operator, notes, opened, closed FROM sessions ";

JobRecord jobOf(const SqlRow& row) {
    JobRecord job{.id = integerOf(row[0]),
                  .kind = textOf(row[1]),
                  .name = textOf(row[2]),
                  .state = stateNamed(textOf(row[3])),
                  .startedUtc = textOf(row[4]),
                  .endedUtc = textOf(row[5]),
                  .error = std::nullopt,
                  .result = textOf(row[8])};
    if (const std::string problem = textOf(row[6]); !problem.empty()) {
        job.error = Error{problemKind(problem), textOf(row[7])};
    }
    return job;
}
constexpr std::string_view kJobs =
    "SELECT id, kind, name, state, started, ended, problem, message, result FROM jobs ";

std::string with(std::string_view select, std::string_view clause) {
    return std::string(select) + std::string(clause);
}

template <class Record, class Make>
Result<std::vector<Record>> all(const Result<std::vector<SqlRow>>& rows, Make make) {
    if (!rows) return rows.error();
    std::vector<Record> records;
    for (const SqlRow& row : *rows) records.push_back(make(row));
    return records;
}

}  // namespace

Result<void> check(const SessionRecord& session) {
    constexpr std::size_t kLongestName = 128, kLongestNotes = 4096;
    for (const std::string* text : {&session.name, &session.operatorName}) {
        const bool printable = std::none_of(text->begin(), text->end(), [](char c) {
            return static_cast<unsigned char>(c) < ' ' || c == '\x7F';
        });
        if (printable && text->size() <= kLongestName) continue;
        return Error{ErrorKind::Usage,
                     "session: a name is at most 128 bytes without control characters"};
    }
    if (session.notes.size() <= kLongestNotes) return {};
    return Error{ErrorKind::Usage, "session: notes are at most 4096 bytes"};
}

std::string_view name(JobState state) { return kStates[static_cast<std::size_t>(state)]; }

std::string titleOf(const JobRecord& job) {
    return job.kind + (job.name.empty() ? "" : " " + job.name);
}

Result<Logbook> Logbook::open(const std::filesystem::path& root) {
    Result<Database> database = openStoreDatabase(root);
    if (!database) return database.error();
    return Logbook(std::move(*database));
}

Result<Logbook> Logbook::openToRead(const std::filesystem::path& root) {
    Result<Database> database = openStoreToRead(root);
    if (!database) return database.error();
    return Logbook(std::move(*database));
}

Result<SessionRecord> Logbook::openSession(SessionRecord session) {
    if (session.name.empty()) session.name = session.openedUtc;
    const Result<void> done = database_.transaction([&]() -> Result<void> {
        const auto open = currentSession();
        if (!open) return open.error();
        if (*open) {
            return Error{
                ErrorKind::Usage,
                "session '" + (*open)->name + "' is open; close it first: gonio session close"};
        }
        const auto same = database_.run("SELECT 1 FROM sessions WHERE name = ?", {session.name});
        if (!same) return same.error();
        if (!same->empty()) {
            return Error{ErrorKind::Usage, "session '" + session.name + "': that name was used"};
        }
        const auto added = database_.run(
            "INSERT INTO sessions(name, operator, notes, opened) VALUES(?, ?, ?, ?) RETURNING id",
            {session.name, session.operatorName, session.notes, session.openedUtc});
        if (!added) return added.error();
        session.id = integerOf(added->front().front());
        return {};
    });
    if (!done) return done.error();
    return session;
}

Result<SessionRecord> Logbook::closeSession(const std::string& dateUtc) {
    const auto closed = database_.run(
        "UPDATE sessions SET closed = ? WHERE closed IS NULL "
        "RETURNING id, name, operator, notes, opened, closed",
        {dateUtc});
    if (!closed) return closed.error();
    if (closed->empty()) {
        return Error{ErrorKind::Usage, "no session is open; open one: gonio session new"};
    }
    return sessionOf(closed->front());
}

Result<std::optional<SessionRecord>> Logbook::currentSession() {
    const auto rows = database_.run(with(kSessions, "WHERE closed IS NULL"));
    if (!rows) return rows.error();
    if (rows->empty()) return std::optional<SessionRecord>();
    return std::optional(sessionOf(rows->front()));
}

Result<std::vector<SessionRecord>> Logbook::sessions() {
    return all<SessionRecord>(database_.run(with(kSessions, "ORDER BY id DESC")), sessionOf);
}

Result<JobRecord> Logbook::beginJob(JobRecord job) {
    const auto added = database_.run(
        "INSERT INTO jobs(kind, name, state, started) VALUES(?, ?, ?, ?) RETURNING id",
        {job.kind, job.name, std::string(daemon::name(job.state)), job.startedUtc});
    if (!added) return added.error();
    job.id = integerOf(added->front().front());
    return job;
}

Result<void> Logbook::endJob(const JobRecord& job) {
    const std::string problem = job.error ? std::string(problemName(job.error->kind)) : "";
    const auto ended = database_.run(
        "UPDATE jobs SET state = ?, ended = ?, problem = ?, message = ?, result = ? WHERE id = ?",
        {std::string(daemon::name(job.state)),
         job.endedUtc,
         orNull(problem),
         orNull(job.error ? job.error->message : ""),
         orNull(job.result),
         job.id});
    return ended ? Result<void>() : ended.error();
}

Result<std::vector<JobRecord>> Logbook::interruptJobs(const std::string& dateUtc) {
    std::vector<JobRecord> interrupted;
    const Result<void> done = database_.transaction([&]() -> Result<void> {
        auto found = all<JobRecord>(database_.run(with(kJobs, "WHERE state = 'running'")), jobOf);
        if (!found) return found.error();
        for (JobRecord& job : *found) {
            job.state = JobState::Interrupted;
            job.endedUtc = dateUtc;
            job.error = Error{ErrorKind::Interrupted,
                              job.kind + ": the daemon ended in the middle of it; start it again"};
            if (Result<void> kept = endJob(job); !kept) return kept;
        }
        interrupted = std::move(*found);
        return {};
    });
    if (!done) return done.error();
    return interrupted;
}

Result<JobRecord> Logbook::job(std::int64_t id) {
    const auto rows = database_.run(with(kJobs, "WHERE id = ?"), {id});
    if (!rows) return rows.error();
    if (rows->empty()) {
        return Error{ErrorKind::Usage, "job " + std::to_string(id) + ": there is none"};
    }
    return jobOf(rows->front());
}

Result<std::vector<JobRecord>> Logbook::jobs(int count) {
    return all<JobRecord>(
        database_.run(with(kJobs, "ORDER BY id DESC LIMIT ?"), {std::int64_t{count}}), jobOf);
}

Result<void> Logbook::addEvent(const EventRecord& event) {
    const auto added =
        database_.run("INSERT INTO events(id, date, type, data) VALUES(?, ?, ?, ?)",
                      {static_cast<std::int64_t>(event.id), event.dateUtc, event.type, event.data});
    return added ? Result<void>() : added.error();
}

Result<std::vector<EventRecord>> Logbook::eventsAfter(std::uint64_t id, int count) {
    return all<EventRecord>(
        database_.run("SELECT id, date, type, data FROM events WHERE id > ? ORDER BY id LIMIT ?",
                      {static_cast<std::int64_t>(id), std::int64_t{count}}),
        [](const SqlRow& row) {
            return EventRecord{.id = static_cast<std::uint64_t>(integerOf(row[0])),
                               .dateUtc = textOf(row[1]),
                               .type = textOf(row[2]),
                               .data = textOf(row[3])};
        });
}

Result<std::uint64_t> Logbook::newestEvent() {
    const auto rows = database_.run("SELECT max(id) FROM events");
    if (!rows) return rows.error();
    return static_cast<std::uint64_t>(integerOf(rows->front().front()));
}

Result<std::string> Logbook::setting(const std::string& name) {
    const auto rows = database_.run("SELECT value FROM settings WHERE name = ?", {name});
    if (!rows) return rows.error();
    return rows->empty() ? std::string() : textOf(rows->front().front());
}

Result<void> Logbook::set(const std::string& name, const std::string& value) {
    const auto done = database_.run(
        "INSERT INTO settings(name, value) VALUES(?, ?) "
        "ON CONFLICT(name) DO UPDATE SET value = excluded.value",
        {name, value});
    return done ? Result<void>() : done.error();
}

}  // namespace gonio::daemon
