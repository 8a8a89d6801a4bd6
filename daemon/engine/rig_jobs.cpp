#include "daemon/engine/rig_jobs.h"

#include <nlohmann/json.hpp>

#include "daemon/rig_records.h"
#include "daemon/rig_sweeps.h"
#include "daemon/stored_darks.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/quality/ambient.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// Keeps it, beside the rig.
Result<CalibrationRecord> keep(const JobRun& run,
                               const CalibrationRecord& record,
                               const Result<std::string>& file) {
    if (!file) return file.error();
    return run.whileAlive([&] { return run.keep(record, {.file = *file}); });
}

/// Quality error for light that leaks in: it would be taken off every sample.
Result<void> checkDark(const JobRun& run, const proc::DarkFrame& longest) {
    constexpr double kSure = 5;
    const auto mirror = run.bench().store.newestCalibration(run.serial(), "mirror");
    if (!mirror || !*mirror) {
        log::warning(
            "without a lens map nothing tells where the field is: light that leaks in is "
            "not looked for");
        return {};
    }
    const Result<LensRecord> lens = readLens(**mirror);
    if (!lens) {
        log::warning(lens.error().message + "; light that leaks in is not looked for");
        return {};
    }
    const auto light = proc::ambientLight(longest, lens->fit.map, kField, run.profile().noise);
    if (!light || light->perSecond < kSure * light->u) return {};
    return Error{ErrorKind::Quality,
                 "light leaks in: " + fixed(light->perSecond, 0) + " electrons per second (u " +
                     fixed(light->u, 0) +
                     ") in the field with all LEDs off; cover the rig, or darken the room"};
}

Json documentOf(const JobRun& run, const CalibrationRecord& kept) {
    return {{"schema", "gonio/calibrate-" + kept.kind + "/1"},
            {"rig", run.serial()},
            {"rig_seconds", run.onRig().count()},
            {"file", kept.file.string()}};
}

}  // namespace

Result<Json> calibrateSensor(const JobRun& run) {
    if (Result<void> placed = run.expectPlaced("white"); !placed) return placed.error();
    const RigProfile& plain = run.bench().profile;  // not with what is to be found again
    run.bench().monitor.begin(sensorSteps());
    Result<SensorRecord> sensor = measureSensor(run.measuring(plain));
    if (!sensor) return sensor.error();
    sensor->dateUtc = run.bench().utcNow();
    const auto kept = keep(run,
                           {.kind = "sensor",
                            .dateUtc = sensor->dateUtc,
                            .profileHash = plain.hash,
                            .celsius = run.celsius()},
                           encodeSensor(*sensor));
    if (!kept) return kept.error();
    Json document = documentOf(run, *kept);
    document["electrons_per_dn"] = sensor->transfer.electronsPerDn;
    document["u_electrons_per_dn"] = sensor->transfer.uElectronsPerDn;
    document["read_noise_electrons"] = sensor->transfer.readNoiseElectrons;
    document["u_read_noise_electrons"] = sensor->transfer.uReadNoiseElectrons;
    document["inl_percent"] = sensor->linearity.inlPercent;
    document["left_percent"] =
        100 * sensor->linearity.largestResidualDn / sensor->linearity.linearity.rangeDn;
    return document;
}

Result<Json> calibrateLeds(const JobRun& run) {
    if (Result<void> placed = run.expectPlaced("white"); !placed) return placed.error();
    run.bench().monitor.begin(warmUpSteps());
    const Result<proc::LedMonitor> leds = measureWarmUp(run.measuring());
    if (!leds) return leds.error();
    const auto kept = keep(run, {.kind = "leds", .celsius = run.celsius()}, encodeLeds(*leds));
    if (!kept) return kept.error();
    Json document = documentOf(run, *kept);
    for (const Band band : kBands) {
        const proc::WarmUpFit& fit = leds->bands[index(band)];
        document["bands"][std::string(letter(band))] = {{"per_kelvin", fit.perKelvin},
                                                        {"u_per_kelvin", fit.uPerKelvin},
                                                        {"celsius", fit.celsius}};
    }
    return document;
}

Result<Json> calibrateDark(const JobRun& run) {
    const Bench bench = run.measuring();
    run.bench().monitor.begin(storedDarkSteps(bench));
    const Result<std::vector<proc::DarkFrame>> darks = measureDarks(bench);
    if (!darks) return darks.error();
    if (Result<void> dark = checkDark(run, darks->back()); !dark) return dark.error();
    const std::optional<double> warmth = run.sensorCelsius();
    const auto kept = keep(run, {.kind = "dark", .celsius = warmth}, run.whileAlive([&] {
        return encodeDarks(*darks);
    }));
    if (!kept) return kept.error();
    Json document = documentOf(run, *kept);
    document["exposures"] = darks->size();
    document["frames"] = darks->front().frames;
    document["sensor_celsius"] = warmth ? Json(*warmth) : Json(nullptr);
    document["hot_pixels"] = darks->back().hot.size();
    return document;
}

}  // namespace gonio::daemon
