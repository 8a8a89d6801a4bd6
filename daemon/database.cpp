#include "daemon/database.h"

#include <sqlite3.h>

namespace gonio::daemon {
namespace {

constexpr int kBusyMilliseconds = 1000;  // half a rig's heartbeat

struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

int bind(sqlite3_stmt* statement, int place, const SqlValue& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) {
        return sqlite3_bind_int64(statement, place, *whole);
    }
    if (const auto* number = std::get_if<double>(&value)) {
        return sqlite3_bind_double(statement, place, *number);
    }
    if (const auto* text = std::get_if<std::string>(&value)) {
        return sqlite3_bind_text64(
            statement, place, text->data(), text->size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    }
    return sqlite3_bind_null(statement, place);
}

SqlValue column(sqlite3_stmt* statement, int place) {
    switch (sqlite3_column_type(statement, place)) {
        case SQLITE_INTEGER: return std::int64_t{sqlite3_column_int64(statement, place)};
        case SQLITE_FLOAT: return sqlite3_column_double(statement, place);
        case SQLITE_NULL: return std::monostate{};
        default: break;
    }
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, place));
    return std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement, place)));
}

}  // namespace

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

Error Database::failed(std::string_view what) const {
    const int code = sqlite3_errcode(handle_.get());
    const bool held = code == SQLITE_BUSY || code == SQLITE_LOCKED || code == SQLITE_READONLY ||
                      code == SQLITE_CANTOPEN || code == SQLITE_PERM;
    return {held ? ErrorKind::Busy : ErrorKind::File,
            "store: " + file_.string() + ": " + std::string(what) + ": " +
                sqlite3_errmsg(handle_.get())};
}

Result<Database> Database::connect(const std::filesystem::path& file, int flags) {
    sqlite3* raw = nullptr;
    const int opened = sqlite3_open_v2(file.c_str(), &raw, flags, nullptr);
    Database database(std::unique_ptr<sqlite3, Close>(raw), file);
    if (opened != SQLITE_OK) return database.failed("open");
    sqlite3_busy_timeout(raw, kBusyMilliseconds);
    return database;
}

Result<Database> Database::open(const std::filesystem::path& file,
                                const std::vector<std::string>& migrations) {
    Result<Database> database = connect(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
    if (!database) return database;
    const Result<void> set = database->execute(
        "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON;");
    if (!set) return set.error();
    if (Result<void> done = database->migrate(migrations); !done) return done.error();
    return database;
}

Result<Database> Database::openToRead(const std::filesystem::path& file, std::size_t version) {
    Result<Database> database = connect(file, SQLITE_OPEN_READONLY);
    if (!database) return database;
    const Result<std::size_t> seen = database->version();
    if (!seen) return seen.error();
    if (*seen != version) return database->otherVersion(*seen, version);
    return database;
}

Result<std::size_t> Database::version() {
    const auto rows = run("PRAGMA user_version");
    if (!rows) return rows.error();
    return static_cast<std::size_t>(integerOf(rows->front().front()));
}

Error Database::otherVersion(std::size_t seen, std::size_t known) const {
    const bool newer = seen > known;
    return {ErrorKind::File,
            "store: " + file_.string() + ": made by " + (newer ? "a newer" : "an older") +
                " gonio (schema " + std::to_string(seen) + ", this one knows " +
                std::to_string(known) + ")" +
                (newer ? "" : "; start goniod on it once, which brings it up to date")};
}

Result<void> Database::migrate(const std::vector<std::string>& migrations) {
    const Result<std::size_t> seen = version();
    if (!seen) return seen.error();
    if (*seen == migrations.size()) return {};  // without the writers' lock
    if (*seen > migrations.size()) return otherVersion(*seen, migrations.size());
    return transaction([&]() -> Result<void> {
        const Result<std::size_t> now = version();  // another may have been quicker
        if (!now) return now.error();
        for (std::size_t i = *now; i < migrations.size(); ++i) {
            if (Result<void> done = execute(migrations[i]); !done) return done;
        }
        return execute("PRAGMA user_version=" + std::to_string(migrations.size()));
    });
}

Result<std::vector<SqlRow>> Database::run(std::string_view text, const SqlRow& values) {
    sqlite3_stmt* raw = nullptr;
    const int prepared = sqlite3_prepare_v2(
        handle_.get(), text.data(), static_cast<int>(text.size()), &raw, nullptr);
    if (prepared != SQLITE_OK) return failed(text);
    const Statement statement(raw);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (bind(raw, static_cast<int>(i) + 1, values[i]) != SQLITE_OK) return failed(text);
    }
    std::vector<SqlRow> rows;
    int stepped = sqlite3_step(raw);
    for (; stepped == SQLITE_ROW; stepped = sqlite3_step(raw)) {
        SqlRow& row = rows.emplace_back();
        for (int i = 0; i < sqlite3_column_count(raw); ++i) row.push_back(column(raw, i));
    }
    if (stepped != SQLITE_DONE) return failed(text);
    return rows;
}

Result<void> Database::execute(const std::string& script) {
    if (sqlite3_exec(handle_.get(), script.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) {
        return {};
    }
    return failed("set up");
}

Result<void> Database::transaction(const std::function<Result<void>()>& work) {
    if (Result<void> begun = execute("BEGIN IMMEDIATE"); !begun) return begun;
    Result<void> done = work();
    if (done) done = execute("COMMIT");
    if (!done) (void)execute("ROLLBACK");
    return done;
}

std::string textOf(const SqlValue& value) {
    const auto* text = std::get_if<std::string>(&value);
    return text != nullptr ? *text : std::string();
}

std::int64_t integerOf(const SqlValue& value) {
    const auto* whole = std::get_if<std::int64_t>(&value);
    return whole != nullptr ? *whole : 0;
}

}  // namespace gonio::daemon
