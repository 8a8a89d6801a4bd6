#include "daemon/store.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "daemon/store_schema.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRawExtension = ".graw";
constexpr const char* kObjects = "objects";

/// Absolute: others, who work in other folders, are told of its files.
Result<fs::path> rootOf(const fs::path& chosen) {
    const fs::path root = chosen.empty() ? defaultStore() : chosen;
    std::error_code failed;
    fs::path absolute = fs::absolute(root, failed).lexically_normal();
    if (failed) {
        return Error{ErrorKind::Usage, "store: " + root.string() + ": " + failed.message()};
    }
    return absolute;
}

SqlValue orNull(const std::optional<double>& number) {
    if (number) return *number;
    return std::monostate{};
}

/// The only one there is, or none.
Result<std::optional<CalibrationRecord>> only(Result<std::vector<CalibrationRecord>> found) {
    if (!found) return found.error();
    if (found->empty()) return std::optional<CalibrationRecord>();
    return std::optional(std::move(found->front()));
}

}  // namespace

fs::path defaultStore() {
    const auto variable = [](const char* name) -> std::string {
        const char* value = std::getenv(name);
        return value != nullptr ? value : "";
    };
    if (const std::string set = variable("GONIO_STORE"); !set.empty()) return set;
    if (const std::string data = variable("XDG_DATA_HOME"); !data.empty()) {
        return fs::path(data) / "gonio";
    }
    if (const std::string home = variable("HOME"); !home.empty()) {
        return fs::path(home) / ".local" / "share" / "gonio";
    }
    return ".gonio";
}

Result<void> checkSampleName(std::string_view name) {
    constexpr std::size_t kLongest = 64;
    const auto alphanumeric = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    const bool good = !name.empty() && name.size() <= kLongest && alphanumeric(name.front()) &&
                      std::all_of(name.begin(), name.end(), [&](char c) {
                          return alphanumeric(c) || c == '.' || c == '_' || c == '-';
                      });
    if (good) return {};
    return Error{ErrorKind::Usage,
                 "sample name '" + std::string(name) +
                     "': wanted 1 to 64 letters, digits, '.', '_' or '-', a letter or digit first"};
}

Result<Store> Store::open(const fs::path& chosen) {
    Result<fs::path> root = rootOf(chosen);
    if (!root) return root.error();
    std::error_code failed;
    fs::create_directories(*root, failed);
    if (failed) {
        return Error{ErrorKind::Busy,
                     "store: cannot make " + root->string() + ": " + failed.message() +
                         "; choose another place with --store DIR"};
    }
    Result<ObjectFolder> objects = ObjectFolder::open(*root / kObjects);
    if (!objects) return objects.error();
    Result<Database> database = openStoreDatabase(*root);
    if (!database) return database.error();
    return Store(std::move(*root), std::move(*objects), std::move(*database));
}

Result<Store> Store::openToRead(const fs::path& chosen) {
    Result<fs::path> root = rootOf(chosen);
    if (!root) return root.error();
    Result<Database> database = openStoreToRead(*root);
    if (!database) return database.error();
    ObjectFolder objects(*root / kObjects);
    return Store(std::move(*root), std::move(objects), std::move(*database));
}

Result<void> Store::sweep() { return objects_.sweep(); }

fs::path Store::pathOf(const SqlValue& object) const {
    const std::string name = textOf(object);
    return name.empty() ? fs::path() : objects_.pathOf(name);
}

SampleRecord Store::sampleOf(const SqlRow& row) const {
    return {.name = textOf(row[0]),
            .rig = textOf(row[1]),
            .dateUtc = textOf(row[2]),
            .session = textOf(row[3]),
            .file = pathOf(row[4]),
            .raw = pathOf(row[5])};
}

Result<Store::Objects> Store::keep(const Contents& contents, std::string_view extension) const {
    Objects objects;
    if (!contents.raw.empty()) {  // first: it is what cannot be had again
        const Result<std::string> raw = objects_.put(contents.raw, kRawExtension);
        if (!raw) return raw.error();
        objects.raw = *raw;
    }
    const Result<std::string> file = objects_.put(contents.file, extension);
    if (!file) return file.error();
    objects.file = *file;
    return objects;
}

Result<std::string> Store::freeName(const std::string& name) {
    for (int number = 1;; ++number) {
        const std::string candidate = name + "." + std::to_string(number);
        const auto rows = database_.run("SELECT 1 FROM samples WHERE name = ?", {candidate});
        if (!rows) return rows.error();
        if (rows->empty()) return candidate;
    }
}

Result<Store::Added> Store::addSample(SampleRecord record, const Contents& contents) {
    if (Result<void> good = checkSampleName(record.name); !good) return good.error();
    const Result<Objects> objects = keep(contents, ".gonio");
    if (!objects) return objects.error();
    std::string movedTo;
    const Result<void> done = database_.transaction([&]() -> Result<void> {
        const auto earlier = database_.run("SELECT 1 FROM samples WHERE name = ?", {record.name});
        if (!earlier) return earlier.error();
        if (!earlier->empty()) {
            const Result<std::string> other = freeName(record.name);
            if (!other) return other.error();
            const auto moved =
                database_.run("UPDATE samples SET name = ? WHERE name = ?", {*other, record.name});
            if (!moved) return moved.error();
            movedTo = *other;
        }
        const auto inserted = database_.run(
            "INSERT INTO samples(name, rig, date, session, file, raw) "
            "VALUES(?, ?, ?, ?, ?, ?)",
            {record.name, record.rig, record.dateUtc, record.session, objects->file, objects->raw});
        return inserted ? Result<void>() : inserted.error();
    });
    if (!done) return done.error();
    record.file = pathOf(objects->file);
    record.raw = pathOf(objects->raw);
    return Added{std::move(record), movedTo};
}

Result<std::optional<SampleRecord>> Store::find(const std::string& name) {
    const auto rows = database_.run(
        "SELECT name, rig, date, session, file, raw FROM samples WHERE name = ?", {name});
    if (!rows) return rows.error();
    if (rows->empty()) return std::optional<SampleRecord>();
    return std::optional(sampleOf(rows->front()));
}

Result<SampleRecord> Store::sample(const std::string& name) {
    auto found = find(name);
    if (!found) return found.error();
    if (!*found) return noSample(name);
    return std::move(**found);
}

Error Store::noSample(const std::string& name) const {
    return {ErrorKind::File,
            "sample:" + name + ": the store " + root_.string() + " has no sample of this name"};
}

Result<std::vector<SampleRecord>> Store::samples() {
    const auto rows =
        database_.run("SELECT name, rig, date, session, file, raw FROM samples ORDER BY name");
    if (!rows) return rows.error();
    std::vector<SampleRecord> all;
    for (const SqlRow& row : *rows) all.push_back(sampleOf(row));
    return all;
}

Result<CalibrationRecord> Store::addCalibration(CalibrationRecord record,
                                                const Contents& contents) {
    const bool json = record.kind == "mirror";
    const Result<Objects> objects = keep(contents, json ? ".json" : ".gonio");
    if (!objects) return objects.error();
    const auto inserted = database_.run(
        "INSERT INTO calibrations(rig, kind, date, file, raw, profile, celsius) "
        "VALUES(?, ?, ?, ?, ?, ?, ?) RETURNING id",
        {record.rig,
         record.kind,
         record.dateUtc,
         objects->file,
         objects->raw,
         record.profileHash,
         orNull(record.celsius)});
    if (!inserted) return inserted.error();
    record.id = integerOf(inserted->front().front());
    record.file = pathOf(objects->file);
    record.raw = pathOf(objects->raw);
    return record;
}

CalibrationRecord Store::calibrationOf(const SqlRow& row) const {
    CalibrationRecord record{.id = integerOf(row[0]),
                             .rig = textOf(row[1]),
                             .kind = textOf(row[2]),
                             .dateUtc = textOf(row[3]),
                             .profileHash = textOf(row[4]),
                             .file = pathOf(row[6]),
                             .raw = pathOf(row[7])};
    if (const auto* celsius = std::get_if<double>(&row[5])) record.celsius = *celsius;
    return record;
}

Result<std::vector<CalibrationRecord>> Store::calibrationsWhere(std::string_view clause,
                                                                const SqlRow& values) {
    const auto rows =
        database_.run("SELECT id, rig, kind, date, profile, celsius, file, raw FROM calibrations " +
                          std::string(clause),
                      values);
    if (!rows) return rows.error();
    std::vector<CalibrationRecord> all;
    for (const SqlRow& row : *rows) all.push_back(calibrationOf(row));
    return all;
}

Result<std::optional<CalibrationRecord>> Store::newestCalibration(
    const std::string& rig, const std::string& kind, std::optional<std::int64_t> before) {
    constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
    return only(calibrationsWhere("WHERE rig = ? AND kind = ? AND id < ? ORDER BY id DESC LIMIT 1",
                                  {rig, kind, before.value_or(kAll)}));
}

Result<std::optional<CalibrationRecord>> Store::calibration(std::int64_t id) {
    return only(calibrationsWhere("WHERE id = ?", {id}));
}

Result<std::vector<CalibrationRecord>> Store::calibrations() {
    return calibrationsWhere("ORDER BY id DESC", {});
}

}  // namespace gonio::daemon
