#pragma once
// Where calibrations and samples are kept, of all rigs.
//
//   gonio.db      what there is (SQLite): samples by name, calibrations by rig, kind and time, and
//                 the logbook (logbook.h)
//   objects/      the files themselves, named by their content
//   sim.json      the simulated rig: serial, seed, what lies under it
//   rig.lock      held by the daemon that owns the rig; goniod.sock is its door
//
// Files first, then their row, then the answer: what was acknowledged survives kill -9 and power
// loss, what was not is absent or whole. Nothing is ever overwritten.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/database.h"
#include "daemon/object_folder.h"
#include "proc/core/result.h"

namespace gonio::daemon {

struct SampleRecord {
    std::string name;
    std::string rig;      ///< serial
    std::string dateUtc;  ///< ISO 8601
    std::string session;  ///< name of the laboratory session; empty: none was open
    std::filesystem::path file;
    std::filesystem::path raw;
};

struct CalibrationRecord {
    std::int64_t id = 0;  ///< ascending with time
    std::string rig;      ///< serial
    std::string kind;     ///< "mirror", "black", "white", "zero", "flat", "leds", "sensor", "dark"
    std::string dateUtc;
    std::string profileHash;          ///< of the rig profile; empty: not known
    std::optional<double> celsius{};  ///< of the LED board when it was taken; dark: of the sensor
    std::filesystem::path file;
    std::filesystem::path raw;  ///< empty: there is none
};

/// Encoded files that belong together.
struct Contents {
    std::string file;
    std::string raw;  ///< empty: there is none
};

/// $GONIO_STORE, else $XDG_DATA_HOME/gonio, else ~/.local/share/gonio.
[[nodiscard]] std::filesystem::path defaultStore();

class Store {
public:
    /// Empty: defaultStore(). Made when it is not there.
    [[nodiscard]] static Result<Store> open(const std::filesystem::path& chosen);
    /// For those who only look: changes nothing. File error when there is no store.
    [[nodiscard]] static Result<Store> openToRead(const std::filesystem::path& chosen);
    /// Takes away what a run that died left half written; for the only one who writes.
    Result<void> sweep();

    [[nodiscard]] const std::filesystem::path& root() const { return root_; }
    [[nodiscard]] std::filesystem::path simState() const { return root_ / "sim.json"; }

    /// Keeps a sample of the record's name, rig and date. An earlier one of that name is kept as
    /// NAME.1, or with the first number that is free: `movedTo`, else empty.
    struct Added {
        SampleRecord sample;
        std::string movedTo;
    };
    [[nodiscard]] Result<Added> addSample(SampleRecord record, const Contents& contents);
    [[nodiscard]] Result<std::optional<SampleRecord>> find(const std::string& name);
    /// File error when there is none.
    [[nodiscard]] Result<SampleRecord> sample(const std::string& name);
    [[nodiscard]] Error noSample(const std::string& name) const;
    /// By name.
    [[nodiscard]] Result<std::vector<SampleRecord>> samples();

    [[nodiscard]] Result<CalibrationRecord> addCalibration(CalibrationRecord record,
                                                           const Contents& contents);
    /// The newest of a rig and kind; of those with a number below `before`, if one is given.
    [[nodiscard]] Result<std::optional<CalibrationRecord>> newestCalibration(
        const std::string& rig, const std::string& kind, std::optional<std::int64_t> before = {});
    [[nodiscard]] Result<std::optional<CalibrationRecord>> calibration(std::int64_t id);
    /// Of all rigs, newest first.
    [[nodiscard]] Result<std::vector<CalibrationRecord>> calibrations();

private:
    Store(std::filesystem::path root, ObjectFolder objects, Database database)
        : root_(std::move(root)), objects_(std::move(objects)), database_(std::move(database)) {}
    [[nodiscard]] std::filesystem::path pathOf(const SqlValue& object) const;
    [[nodiscard]] SampleRecord sampleOf(const SqlRow& row) const;
    [[nodiscard]] CalibrationRecord calibrationOf(const SqlRow& row) const;
    [[nodiscard]] Result<std::vector<CalibrationRecord>> calibrationsWhere(std::string_view clause,
                                                                           const SqlRow& values);
    [[nodiscard]] Result<std::string> freeName(const std::string& name);
    struct Objects {
        std::string file;
        SqlValue raw;
    };
    [[nodiscard]] Result<Objects> keep(const Contents& contents, std::string_view extension) const;

    std::filesystem::path root_;
    ObjectFolder objects_;
    Database database_;
};

/// Usage error unless NAME is 1..64 of letters, digits, '.', '_', '-' and starts with a letter or a
/// digit.
[[nodiscard]] Result<void> checkSampleName(std::string_view name);

}  // namespace gonio::daemon
