// Works a stored sample out again, with another calibration of its rig.

#include <nlohmann/json.hpp>

#include "daemon/calibrations.h"
#include "daemon/engine/job.h"
#include "daemon/measurement.h"
#include "daemon/references.h"
#include "daemon/sample_quality.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"
#include "proc/table/rotations.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// The set that a sample was measured with; `newest` where its name is not one of these, as names
/// once were not.
Result<CalibrationSet> measuredWith(Store& store,
                                    const proc::SampleInfo& info,
                                    const CalibrationSet& newest) {
    Result<CalibrationSet> own = parseSet(store, info.calibrationId, newest);
    if (own) return own;
    if (own.error().kind == ErrorKind::Usage) return newest;
    return own.error().in("what the sample was measured with");
}

/// The sensor calibration that the sample's frames were merged with, by its profile's hash
/// (withSensor); empty: none.
Result<std::optional<CalibrationRecord>> sensorOf(Store& store, const proc::SampleInfo& info) {
    const std::size_t slash = info.profileHash.find('/');
    if (slash == std::string::npos) return std::optional<CalibrationRecord>();
    const auto id = parseInteger(std::string_view(info.profileHash).substr(slash + 1));
    auto found = id ? store.calibration(*id) : std::optional<CalibrationRecord>();
    if (!found) return found.error();
    if (*found) return std::move(*found);
    return Error{ErrorKind::Quality,
                 "sample '" + info.name + "': its sensor calibration " +
                     info.profileHash.substr(slash + 1) + " is not in the store"};
}

/// The sensor is the sample's own: its figures are in the merged pictures.
Result<CalibrationSet> wantedSet(Store& store,
                                 const proc::SampleInfo& info,
                                 const std::string& calibration) {
    Result<CalibrationSet> newest = newestSet(store, info.rigSerial);
    if (!newest) return newest;
    auto sensor = sensorOf(store, info);
    if (!sensor) return sensor.error();
    newest->sensor = *sensor;
    if (calibration.empty()) return newest;
    const bool whole = calibration.find('+') != std::string::npos;
    const Result<CalibrationSet> others = whole ? newest : measuredWith(store, info, *newest);
    if (!others) return others;
    Result<CalibrationSet> wanted = parseSet(store, calibration, *others);
    if (!wanted) return wanted;
    const auto idOf = [](const std::optional<CalibrationRecord>& record) {
        return record ? record->id : 0;
    };
    if (idOf(wanted->sensor) == idOf(*sensor)) return wanted;
    return Error{ErrorKind::Usage,
                 "calibration '" + calibration +
                     "': the sensor's figures are in the sample's pictures already, and cannot be "
                     "exchanged"};
}

/// Quality error for a tile that was merged with other figures of the sensor than the sample.
Result<void> checkSameSensor(const CalibrationSet& set, const proc::SampleInfo& info) {
    std::vector<const CalibrationRecord*> tiles{&set.black, &set.white};
    if (set.zero) tiles.push_back(&*set.zero);
    for (const CalibrationRecord* tile : tiles) {
        const bool known = !tile->profileHash.empty() && !info.profileHash.empty();
        if (!known || tile->profileHash == info.profileHash) continue;
        return Error{ErrorKind::Quality,
                     tile->kind + " calibration " + std::to_string(tile->id) +
                         " was merged with other figures of the sensor, or another rig profile, "
                         "than the sample; name one of the sample's: recalibrate --calibration"};
    }
    return {};
}

/// The sample's raw signals and both references hold every LED and band that it has.
Result<void> checkComplete(const PlacementSignals& signals,
                           const LoadedSet& references,
                           const SampleRecord& sample,
                           std::size_t leds) {
    const Result<void> own = daemon::checkComplete(signals, leds, sample.raw.string());
    if (!own) return own;
    for (const ReferenceRecord* one : {&references.black, &references.white}) {
        const Result<void> fits =
            daemon::checkComplete(one->signals, leds, "the " + one->info.name + " reference");
        if (!fits) return fits;
    }
    return {};
}

std::vector<Radians> anglesOf(const proc::SampleSet& sample) {
    std::vector<Radians> angles;
    for (const proc::LedTable& led : sample.leds) angles.push_back(led.incidence);
    return angles;
}

struct Original {
    SampleRecord record;
    std::string bytes;
    proc::SampleSet sample;
};

Result<Original> original(Store& store, const std::string& name) {
    Result<SampleRecord> record = store.sample(name);
    if (!record) return record.error();
    Result<std::string> bytes = proc::readFile(record->file);
    if (!bytes) return bytes.error();
    Result<proc::SampleSet> sample = proc::decodeGonio(*bytes, record->file.string());
    if (!sample) return sample.error();
    return Original{std::move(*record), std::move(*bytes), std::move(*sample)};
}

Result<std::string> workedOut(const Desk& desk,
                              const Original& before,
                              const CalibrationSet& set,
                              int monteCarlo) {
    const Result<LoadedSet> loaded = loadSet(desk.store, set);
    if (!loaded) return loaded.error();
    RigProfile profile = desk.profile;
    if (set.sensor) {
        const Result<SensorRecord> sensor = readSensor(*set.sensor);
        if (!sensor) return sensor.error();
        profile = withSensor(std::move(profile), *sensor, set.sensor->id);
    }
    const Result<References> certified = loadReferences(profile);
    if (!certified) return certified.error();
    const Result<PlacementSignals> signals = binned(before.record.raw, loaded->view);
    if (!signals) return signals.error();
    const Result<void> complete =
        checkComplete(*signals, *loaded, before.record, before.sample.leds.size());
    if (!complete) return complete.error();
    proc::SampleInfo info = before.sample.info;
    info.calibrationId = set.id();
    noteLimits(profile.quality, info);
    if (monteCarlo > 0) noteDraws(monteCarlo, info);
    const proc::MonteCarlo draws = drawsOf(info);
    info.referenceCertificate = certified->white->certificate().citation;
    // Whatever its verdicts say now: it was accepted when it was measured.
    proc::SampleSet sample = calibrateSample(*signals,
                                             anglesOf(before.sample),
                                             referencesOf(*loaded, *certified, profile),
                                             std::move(info),
                                             draws);
    proc::turnTo(sample, before.sample.leds.front().rotation);
    judgeTable(sample, profile.quality.sample);
    return proc::encodeGonio(sample);
}

}  // namespace

Result<std::string> recalibrate(const Desk& desk, const JobRequest& request) {
    const Result<Original> before = original(desk.store, request.name);
    if (!before) return before.error();
    if (Result<void> on = desk.goOn(); !on) return on.error();
    const Result<CalibrationSet> set =
        wantedSet(desk.store, before->sample.info, request.calibration);
    if (!set) return set.error();
    if (Result<void> same = checkSameSensor(*set, before->sample.info); !same) return same.error();
    const Result<std::string> bytes = workedOut(desk, *before, *set, request.monteCarlo);
    if (!bytes) return bytes.error();
    if (Result<void> on = desk.goOn(); !on) return on.error();
    SampleRecord record = before->record;
    std::string earlier;
    const bool identical = *bytes == before->bytes;
    if (!identical) {
        const Result<std::string> raw = proc::readFile(record.raw);
        if (!raw) return raw.error();
        auto added = desk.store.addSample(record, {.file = *bytes, .raw = *raw});
        if (!added) return added.error();
        record = std::move(added->sample);
        earlier = std::move(added->movedTo);
    }
    const Json document{{"schema", "gonio/recalibrate/1"},
                        {"name", request.name},
                        {"file", record.file.string()},
                        {"calibration", set->id()},
                        {"before", before->sample.info.calibrationId},
                        {"identical", identical},
                        {"earlier", earlier.empty() ? Json(nullptr) : Json(earlier)}};
    return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gonio::daemon
