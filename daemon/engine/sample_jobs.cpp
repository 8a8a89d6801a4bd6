#include "daemon/engine/sample_jobs.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/engine/plan_document.h"
#include "daemon/planned_run.h"
#include "daemon/sample_quality.h"
#include "daemon/stored_darks.h"
#include "daemon/then_dark.h"
#include "proc/core/log.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/gonio_exr.h"
#include "proc/table/rotations.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestRefused = 56;  // of a name, that ".refused" may follow

/// What a sample is held against, good for this rig.
struct Loaded {
    CalibrationSet set;
    LoadedSet records;
    References certified;
};

/// What was planned for the sample, was captured of it, and is achieved by that.
struct Taken {
    Captured captured;
    Json planned, achieved;
    double wanted = 0;
};

/// Quality error for calibrations that are no longer good.
Result<void> checkValidity(const JobRun& run, const CalibrationSet& set) {
    const RigNow now = run.now();
    for (const CalibrationRecord* one : {&set.mirror, &set.black, &set.white}) {
        const std::string why = whyNot(*one, now, run.profile().validity);
        if (why.empty()) continue;
        if (!run.request().force)
            return Error{ErrorKind::Quality, why + ", or measure with --force"};
        log::warning(why + "; used all the same");
    }
    return {};
}

int measuredCells(const proc::SampleSet& set) {
    int cells = 0;
    for (const proc::LedTable& led : set.leds) {
        for (const proc::CellSamples& band : led.bands) {
            for (std::size_t cell = 0; cell < band.size(); ++cell)
                cells += band.present(cell) ? 1 : 0;
        }
    }
    return cells;
}

Result<SampleRecord> keep(const JobRun& run,
                          const std::string& name,
                          const proc::SampleSet& set,
                          std::vector<proc::RawState> states) {
    const Result<std::string> raw = rawBytes(set, std::move(states));
    if (!raw) return raw.error();
    const Result<std::string> bytes = proc::encodeGonio(set);
    if (!bytes) return bytes.error();
    auto kept = run.bench().store.addSample({.name = name,
                                             .rig = run.serial(),
                                             .dateUtc = set.info.dateUtc,
                                             .session = run.bench().session},
                                            {.file = *bytes, .raw = *raw});
    if (!kept) return kept.error();
    if (!kept->movedTo.empty()) {
        log::warning("sample '" + name + "' was there; it is kept as '" + kept->movedTo + "'");
    }
    return std::move(kept->sample);
}

/// Looked for before the rig is asked for anything.
Result<BackingEvidence> backingEvidence(const JobRun& run) {
    BackingEvidence evidence{
        .backing = run.request().backing, .other = {}, .rotation = run.request().rotation};
    if (run.request().against.empty()) return evidence;
    const Result<SampleRecord> record = run.bench().store.sample(run.request().against);
    if (!record) return record.error();
    auto other = run.whileAlive([&] { return proc::readGonio(record->file); });
    if (!other) return other.error();
    evidence.other = std::move(*other);
    if (Result<void> good = checkOther(evidence); !good) return good.error();
    return evidence;
}

Result<Loaded> load(const JobRun& run) {
    Result<CalibrationSet> set = newestSet(run.bench().store, run.serial());
    if (!set) return set.error();
    if (Result<void> good = checkValidity(run, *set); !good) return good.error();
    // One whose file cannot be read is not in the figures that the run goes by.
    if (set->sensor && !run.profile().hash.ends_with("/" + std::to_string(set->sensor->id)))
        set->sensor.reset();
    leaveOutStale(*set, run.now(), run.profile().validity);
    auto records = run.whileAlive([&] { return loadSet(run.bench().store, *set); });
    if (!records) return records.error();
    std::vector<const ReferenceRecord*> all{&records->black, &records->white};
    if (records->zero) all.push_back(&*records->zero);
    for (const ReferenceRecord* one : all) {
        if (Result<void> fits = run.fitsThisRig(*one); !fits) return fits.error();
    }
    auto certified = run.whileAlive([&] { return loadReferences(run.profile()); });
    if (!certified) return certified.error();
    return Loaded{std::move(*set), std::move(*records), std::move(*certified)};
}

/// What a sample's pictures are taken and put right with.
Bench benchOf(const JobRun& run, const View& view) {
    Bench bench = run.measuring();
    bench.glare = view.lens.glare;
    bench.corrections = view.corrections;
    const auto record =
        darksAt(run.bench().store, run.sensorCelsius(), run.now(), run.profile().validity);
    if (!record) return bench;
    auto darks = run.whileAlive([&] { return readDarks(*record); });
    if (darks) {
        bench.darks = std::move(*darks);
    } else {
        log::warning(darks.error().message + "; measured without it");
    }
    return bench;
}

Result<Taken> take(const JobRun& run, const Loaded& loaded, const RigReferences& references) {
    const Bench bench = benchOf(run, loaded.records.view);
    PlannedRun planned(bench, references, run.request().goal.plan());
    run.bench().monitor.begin(planned.steps());
    const Result<const proc::Plan*> plan = planned.plan();
    if (!plan) return plan.error();
    run.bench().monitor.begin(planned.steps());
    Taken taken{
        .captured = {}, .planned = promiseOf(**plan), .achieved = {}, .wanted = (*plan)->wanted};
    run.bench().monitor.planned(**plan);
    Result<Captured> captured = planned.capture();
    if (!captured) return captured.error();
    taken.captured = std::move(*captured);
    taken.achieved = {{"seconds", run.onRig().count()}};
    taken.achieved.update(toJson(planned.achieved(taken.captured)));
    return taken;
}

}  // namespace

Result<Json> plan(const JobRun& run) {
    const Result<Loaded> loaded = load(run);
    if (!loaded) return loaded.error();
    const Bench bench = benchOf(run, loaded->records.view);
    const RigReferences references =
        referencesOf(loaded->records, loaded->certified, run.profile());
    PlannedRun planned(bench, references, run.request().goal.plan());
    run.bench().monitor.begin(planned.steps());
    const Result<const proc::Plan*> plan = thenDark(bench, planned.plan());
    if (!plan) return plan.error();
    Json document{
        {"schema", "gonio/plan/1"}, {"rig", run.serial()}, {"goal", run.request().goal.name()}};
    document.update(toJson(**plan));
    document["rig_seconds"] = run.onRig().count();
    return document;
}

Result<Json> measure(const JobRun& run) {
    const Result<Loaded> loaded = load(run);
    if (!loaded) return loaded.error();
    const RigReferences references =
        referencesOf(loaded->records, loaded->certified, run.profile());
    const Result<BackingEvidence> backing = backingEvidence(run);
    if (!backing) return backing.error();
    Result<Taken> taken = take(run, *loaded, references);
    if (!taken) return taken.error();
    Captured* const captured = &taken->captured;

    proc::SampleInfo about = run.info(run.request().name);
    about.effort = run.request().goal.name();
    about.requestedUncertainty = taken->wanted;
    about.referenceCertificate = loaded->certified.white->certificate().citation;
    about.calibrationId = loaded->set.id();
    run.finish(about, *captured);
    if (run.request().monteCarlo > 0) noteDraws(run.request().monteCarlo, about);
    const std::vector<Radians> angles = run.ledAngles();
    proc::SampleSet sample;
    const auto kept = run.whileAlive([&]() -> Result<SampleRecord> {
        const Stopwatch calibrating(run.bench().computer);
        sample = calibrateSample(captured->signals, angles, references, about, drawsOf(about));
        proc::turnTo(sample, run.request().rotation);
        judgeCapture(sample, *captured, references);
        judgeTable(sample, run.profile().quality.sample);
        judgeBacking(sample, *backing, run.profile().quality.sample);
        sample.info.computeSeconds += calibrating.elapsed().count();
        const Result<void> good = accepted(sample, run.request().force);
        if (good) return keep(run, run.request().name, sample, std::move(captured->raw.states));
        const std::string aside = run.request().name.substr(0, kLongestRefused) + ".refused";
        const auto refused = keep(run, aside, sample, std::move(captured->raw.states));
        if (!refused) return refused.error();
        return Error{good.error().kind, good.error().message + "; it is kept as '" + aside + "'"};
    });
    if (!kept) return kept.error();
    const std::optional<double> median = sample.info.achievedUncertainty;
    return Json{{"schema", "gonio/measure/1"},
                {"name", run.request().name},
                {"file", kept->file.string()},
                {"raw", kept->raw.string()},
                {"effort", sample.info.effort},
                {"rotation_deg", proc::fileDegrees(run.request().rotation)},
                {"calibration", loaded->set.id()},
                {"measured_cells", measuredCells(sample)},
                {"median_relative_uncertainty", median ? Json(*median) : Json()},
                {"chi_square_per_freedom", captured->chiSquarePerFreedom},
                {"planned", taken->planned},
                {"achieved", taken->achieved},
                {"qc", Json::parse(sample.info.qcVerdicts)},
                {"rig_seconds", sample.info.rigSeconds},
                {"compute_seconds", sample.info.computeSeconds}};
}

}  // namespace gonio::daemon
