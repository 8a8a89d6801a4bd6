#include "daemon/store_schema.h"

#include <string>
#include <vector>

namespace gonio::daemon {
namespace {

constexpr const char* kFile = "gonio.db";

const std::vector<std::string> kMigrations{
    R"(
    CREATE TABLE samples(
        name TEXT PRIMARY KEY, rig TEXT NOT NULL, date TEXT NOT NULL,
        file TEXT NOT NULL, raw TEXT);
    CREATE TABLE calibrations(
        id INTEGER PRIMARY KEY, rig TEXT NOT NULL, kind TEXT NOT NULL, date TEXT NOT NULL,
        file TEXT NOT NULL, raw TEXT);
    CREATE INDEX newest_calibration ON calibrations(rig, kind, id);
)",
    R"(
    ALTER TABLE samples ADD COLUMN session TEXT;
    CREATE TABLE sessions(
        id INTEGER PRIMARY KEY AUTOINCREMENT, name TEXT NOT NULL UNIQUE, operator TEXT NOT NULL,
        notes TEXT NOT NULL, opened TEXT NOT NULL, closed TEXT);
    CREATE TABLE jobs(
        id INTEGER PRIMARY KEY AUTOINCREMENT, kind TEXT NOT NULL, name TEXT NOT NULL,
        state TEXT NOT NULL, started TEXT NOT NULL, ended TEXT, problem TEXT, message TEXT,
        result TEXT);
    CREATE TABLE events(
        id INTEGER PRIMARY KEY, date TEXT NOT NULL, type TEXT NOT NULL, data TEXT NOT NULL);
    CREATE TABLE settings(name TEXT PRIMARY KEY, value TEXT NOT NULL);
)",
    R"(
    ALTER TABLE calibrations ADD COLUMN profile TEXT;
    ALTER TABLE calibrations ADD COLUMN celsius REAL;
)"};

}  // namespace

Result<Database> openStoreDatabase(const std::filesystem::path& root) {
    return Database::open(root / kFile, kMigrations);
}

Result<Database> openStoreToRead(const std::filesystem::path& root) {
    std::error_code failed;
    if (!std::filesystem::exists(root / kFile, failed)) {
        return Error{failed ? ErrorKind::Busy : ErrorKind::File,
                     "store: " + root.string() + ": " +
                         (failed ? failed.message() : "there is none") +
                         "; choose another with --store DIR"};
    }
    return Database::openToRead(root / kFile, kMigrations.size());
}

}  // namespace gonio::daemon
