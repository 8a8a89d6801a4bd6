#include "daemon/report_source.h"

#include <sstream>

#include "daemon/calibrations.h"
#include "daemon/digest.h"
#include "daemon/logbook.h"
#include "daemon/store.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"

namespace gonio::daemon {
namespace {

constexpr double kHour = 3600;

proc::ReportedCalibration reported(const CalibrationRecord& record, const std::string& measured) {
    proc::ReportedCalibration one{.kind = record.kind,
                                  .number = record.id,
                                  .dateUtc = record.dateUtc,
                                  .ageHours = {},
                                  .celsius = record.celsius,
                                  .profileHash = record.profileHash};
    if (const auto age = ageAt(record, measured)) one.ageHours = age->count() / kHour;
    return one;
}

/// Those of "10+11+12" that the store has of the sample's rig; what is no number is passed over.
Result<std::vector<proc::ReportedCalibration>> calibrationsOf(const proc::SampleInfo& info,
                                                              Store& store) {
    std::vector<proc::ReportedCalibration> all;
    std::istringstream numbers(info.calibrationId);
    for (std::string word; std::getline(numbers, word, '+');) {
        const auto number = parseInteger(word);
        if (!number) continue;
        const auto record = store.calibration(*number);
        if (!record) return record.error();
        if (*record && (*record)->rig == info.rigSerial)
            all.push_back(reported(**record, info.dateUtc));
    }
    return all;
}

Result<std::string> operatorOf(const std::string& session, const std::filesystem::path& store) {
    if (session.empty()) return std::string();
    Result<Logbook> logbook = Logbook::openToRead(store);
    if (!logbook) return logbook.error();
    const auto sessions = logbook->sessions();
    if (!sessions) return sessions.error();
    for (const SessionRecord& one : *sessions) {
        if (one.name == session) return one.operatorName;
    }
    return std::string();
}

/// What the store knows of the sample besides its file.
Result<void> askStore(const proc::SampleInfo& info,
                      const std::filesystem::path& chosen,
                      proc::ReportOrigin& origin) {
    Result<Store> store = Store::openToRead(chosen);
    if (!store) return store.error();
    auto calibrations = calibrationsOf(info, *store);
    if (!calibrations) return calibrations.error();
    origin.calibrations = std::move(*calibrations);
    if (origin.calibrations.empty())
        origin.noCalibrations = "The store has none of these calibrations.";
    const auto name = operatorOf(info.session, store->root());
    if (!name) return name.error();
    origin.operatorName = *name;
    return {};
}

}  // namespace

Result<ReportSource> openForReport(const std::string& f, const std::filesystem::path& store) {
    const Result<std::filesystem::path> file = fileOf(f, store);
    if (!file) return file.error();
    Result<Material> material = openMaterial(file->string(), store);
    if (!material) return material.error();
    if (material->sample == nullptr) {
        return Error{ErrorKind::Usage,
                     "'" + f + "' is no measured sample; wanted a .gonio file or sample:NAME"};
    }
    const Result<std::string> bytes = proc::readFile(*file);
    if (!bytes) return bytes.error();
    ReportSource source{.material = std::move(*material), .origin = {}};
    source.origin.file = isStored(f) ? f : file->filename().string();
    source.origin.digest = digestOf(*bytes);
    if (!isStored(f)) {
        source.origin.noCalibrations =
            "Dates and ages of these calibrations stand in the store that they were made in; a "
            "report of sample:NAME has them.";
        return source;
    }
    const Result<void> asked = askStore(source.material.sample->info, store, source.origin);
    if (!asked) return asked.error();
    return source;
}

}  // namespace gonio::daemon
