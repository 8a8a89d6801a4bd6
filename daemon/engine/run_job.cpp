// The jobs themselves: capture, calibrate, keep, describe.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/alongside.h"
#include "daemon/calibrations.h"
#include "daemon/engine/job.h"
#include "daemon/engine/plan_document.h"
#include "daemon/measurement.h"
#include "daemon/planned_run.h"
#include "daemon/sample_quality.h"
#include "proc/core/log.h"
#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/formats/gonio_exr.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDarkFrames = 4;
constexpr std::size_t kLongestRefused = 56;  // of a name, that ".refused" may follow
// White multiplies into every later sample, so it is averaged longest: 16 frames at least. Its 320
// us leave a tile just unsaturated; 1.28 ms add light where the view is dim.
constexpr BracketPlan kWhiteBracket{.frames = 8, .dim = false, .longest = 3, .first = 2};
constexpr BracketPlan kBlackBracket{.frames = 8, .dim = false, .longest = -1, .first = 5};
// A check of the white asks for a mean over all cells: one frame is plenty.
constexpr BracketPlan kVerifyBracket{.frames = 1, .dim = false, .longest = 2, .first = 2};

std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

/// One run of one job, and how long it took.
class JobRun {
public:
    JobRun(const JobBench& bench, const JobRequest& request)
        : bench_(bench),
          request_(request),
          serial_(bench.rig.identify().serial),
          onRig_(bench.rig.link().clock()) {}

    Result<Json> calibrateMirror();
    Result<Json> calibrateTile(const std::string& kind);
    Result<Json> verifyWhite();
    Result<Json> measure();
    Result<Json> plan();

private:
    [[nodiscard]] Bench measuring() const {
        return {.rig = bench_.rig,
                .profile = bench_.profile,
                .nextPlanStep = bench_.nextPlanStep,
                .clock = bench_.computer,
                .step = [this](const std::string& what) { return bench_.monitor.step(what); },
                .alive = [this] { bench_.monitor.alive(); },
                .outlook = [this](const proc::Progress& now) { bench_.monitor.outlook(now); }};
    }
    /// What `work` answers, which takes long; rig and watchdog are fed meanwhile.
    template <class Work>
    auto whileAlive(Work work) const {
        return alongside(
            bench_.rig, [this] { bench_.monitor.alive(); }, std::move(work));
    }
    [[nodiscard]] std::size_t leds() const { return bench_.rig.identify().ledAngles.size(); }
    [[nodiscard]] proc::SampleInfo info(const std::string& name) const;
    /// Takes all states of what lies under the rig, which is dark afterwards.
    Result<Captured> capture(const BracketPlan& plan, int darkFrames);
    /// What a sample is held against, good for this rig.
    struct Loaded {
        CalibrationSet set;
        LoadedSet records;
        References certified;
    };
    [[nodiscard]] Result<Loaded> load() const;
    /// What was planned for the sample, was captured of it, and is achieved by that.
    struct Taken {
        Captured captured;
        Json planned, achieved;
        double wanted = 0;
    };
    [[nodiscard]] Result<Taken> take(const RigReferences& references);
    [[nodiscard]] Result<void> expectPlaced(const std::string& reference) const;
    Result<void> placeMirror(const proc::Wedge& wedge);
    [[nodiscard]] std::optional<double> celsius() const;
    [[nodiscard]] RigNow rigNow() const;
    [[nodiscard]] Result<void> checkValidity(const CalibrationSet& set) const;
    [[nodiscard]] Result<void> fitsThisRig(const ReferenceRecord& reference) const;
    [[nodiscard]] Result<ReferenceRecord> reference(const std::string& kind) const;
    [[nodiscard]] Result<BackingEvidence> backingEvidence() const;
    void finish(proc::SampleInfo& info, const Captured& captured) const;
    Result<SampleRecord> keep(const std::string& name,
                              const proc::SampleSet& set,
                              std::vector<proc::RawState> states);

    const JobBench& bench_;
    const JobRequest& request_;
    std::string serial_;
    Stopwatch onRig_;
};

/// What every file of this job says of its origin.
proc::SampleInfo JobRun::info(const std::string& name) const {
    proc::SampleInfo info;
    info.name = name;
    info.rigSerial = serial_;
    info.profileHash = bench_.profile.hash;
    info.session = bench_.session;
    info.dateUtc = bench_.utcNow();
    info.softwareVersion = "gonio " GONIO_VERSION;
    info.operatorNotes = request_.notes;
    bench_.port.describe(info);
    return info;
}

Result<std::string> rawBytes(const proc::SampleInfo& info, std::vector<proc::RawState> states) {
    return proc::encodeGraw({.info = {{"name", info.name},
                                      {"rig_serial", info.rigSerial},
                                      {"profile_hash", info.profileHash},
                                      {"date", info.dateUtc},
                                      {"software", info.softwareVersion}},
                             .states = std::move(states)});
}

void JobRun::finish(proc::SampleInfo& info, const Captured& captured) const {
    info.rigSeconds = onRig_.elapsed().count();
    info.computeSeconds = captured.compute.count();
    info.extra["chi_square_per_freedom"] = shortest(captured.chiSquarePerFreedom);
    const std::string steps = described(captured.lightSteps);
    info.extra["light"] = steps.empty() ? "steady within each bracket" : steps;
}

Result<Captured> JobRun::capture(const BracketPlan& plan, int darkFrames) {
    const Result<CalibrationRecord> mirror = newestOf(bench_.store, serial_, "mirror");
    if (!mirror) return mirror.error();
    const Result<LensRecord> lens = readLens(*mirror);
    if (!lens) return lens.error();
    Bench bench = measuring();
    bench.glare = lens->glare;
    bench_.monitor.begin(placementSteps(bench));
    Result<Captured> captured = measurePlacement(bench, lens->fit.map, plan, darkFrames);
    if (!captured) return captured;
    if (Result<void> dark = bench_.rig.darken(); !dark) return dark.error();
    bench_.monitor.captured();
    return captured;
}

Result<void> JobRun::expectPlaced(const std::string& reference) const {
    const std::string placed = bench_.port.placed();
    if (placed.empty() || placed == reference) return {};
    return Error{ErrorKind::Quality,
                 "under the rig lies '" + placed + "'; place the " + reference +
                     " first: gonio sim place " + reference};
}

Result<void> JobRun::placeMirror(const proc::Wedge& wedge) {
    const Result<bool> placed = bench_.port.placeMirror(wedge);
    if (!placed) return placed.error();
    if (*placed) return {};
    return bench_.monitor.ask("put the mirror on the wedge of " + fixed(wedge.aboutX.degrees(), 0) +
                              " degrees about x and " + fixed(wedge.aboutY.degrees(), 0) +
                              " degrees about y");
}

/// A reference is of this rig's LEDs, or its cells would be taken for others'.
Result<void> JobRun::fitsThisRig(const ReferenceRecord& reference) const {
    if (reference.signals.size() == leds()) return {};
    const std::string& kind = reference.info.name;
    return Error{ErrorKind::Quality,
                 "the " + kind + " reference of " + serial_ + " has " +
                     std::to_string(reference.signals.size()) + " LEDs, the rig " +
                     std::to_string(leds()) + "; run: gonio calibrate " + kind};
}

/// The newest, as the newest lens map bins it.
Result<ReferenceRecord> JobRun::reference(const std::string& kind) const {
    const Result<CalibrationRecord> record = newestOf(bench_.store, serial_, kind);
    if (!record) return record.error();
    const Result<CalibrationRecord> mirror = newestOf(bench_.store, serial_, "mirror");
    if (!mirror) return mirror.error();
    const Result<LensRecord> lens = readLens(*mirror);
    if (!lens) return lens.error();
    auto found = whileAlive([&] { return readReference(bench_.store, *record, *mirror, *lens); });
    if (!found) return found;
    if (Result<void> fits = fitsThisRig(*found); !fits) return fits.error();
    return found;
}

std::optional<double> JobRun::celsius() const {
    const auto& status = bench_.rig.link().status();
    return status ? driver::celsius(status->temperature[0]) : std::nullopt;
}

RigNow JobRun::rigNow() const {
    return {.serial = serial_,
            .profileHash = bench_.profile.hash,
            .celsius = celsius(),
            .dateUtc = bench_.utcNow()};
}

/// Quality error for calibrations that are no longer good.
Result<void> JobRun::checkValidity(const CalibrationSet& set) const {
    const RigNow now = rigNow();
    for (const CalibrationRecord* one : {&set.mirror, &set.black, &set.white}) {
        const std::string why = whyNot(*one, now, bench_.profile.validity);
        if (why.empty()) continue;
        if (!request_.force) return Error{ErrorKind::Quality, why + ", or measure with --force"};
        log::warning(why + "; used all the same");
    }
    return {};
}

/// Quality error for light that changed in the middle of a bracket.
Result<void> checkSteady(const Captured& captured, const std::string& whatToDo) {
    if (captured.lightSteps.empty()) return {};
    return Error{ErrorKind::Quality,
                 "the light changed: " + described(captured.lightSteps) + "; " + whatToDo};
}

Result<Json> JobRun::calibrateMirror() {
    if (Result<void> placed = expectPlaced("mirror"); !placed) return placed.error();
    const Bench bench = measuring();
    bench_.monitor.begin(mirrorSteps(bench));
    Result<LensRecord> lens =
        measureLens(bench, [this](const proc::Wedge& wedge) { return placeMirror(wedge); });
    if (!lens) return lens.error();
    if (Result<void> dark = bench_.rig.darken(); !dark) return dark.error();
    bench_.monitor.captured();
    lens->dateUtc = bench_.utcNow();
    const std::optional<double> warmth = celsius();  // of a link that only this thread reads
    const auto kept = whileAlive([&] {
        return bench_.store.addCalibration({.rig = serial_,
                                            .kind = "mirror",
                                            .dateUtc = lens->dateUtc,
                                            .profileHash = bench_.profile.hash,
                                            .celsius = warmth},
                                           {.file = encodeLens(*lens)});
    });
    if (!kept) return kept.error();
    return Json{{"schema", "gonio/calibrate-mirror/1"},
                {"rig", serial_},
                {"spots", lens->spots},
                {"rms_px", lens->fit.rmsPixels},
                {"worst_px", lens->fit.worstPixels},
                {"glare_share", lens->glare ? Json(lens->glare->share()) : Json(nullptr)},
                {"glare_u_share", lens->glare ? Json(lens->glare->uShare) : Json(nullptr)},
                {"rig_seconds", onRig_.elapsed().count()},
                {"file", kept->file.string()}};
}

/// A white is held against the black, and so is a light trap: it must be darker.
Result<void> checkAgainst(const ReferenceRecord& black,
                          const PlacementSignals& signals,
                          const std::string& kind) {
    if (kind == "white") return checkWhite(signals, black.signals);
    return kind == "zero" ? checkZero(signals, black.signals) : Result<void>();
}

Result<Json> JobRun::calibrateTile(const std::string& kind) {
    const bool white = kind == "white";
    if (Result<void> placed = expectPlaced(kind); !placed) return placed.error();
    // Looked for before minutes go into what would be refused without it.
    const Result<ReferenceRecord> black =
        kind != "black" ? reference("black") : Result<ReferenceRecord>(ReferenceRecord{});
    if (!black) return black.error();
    Result<Captured> captured = capture(white ? kWhiteBracket : kBlackBracket, 2 * kDarkFrames);
    if (!captured) return captured.error();
    if (Result<void> steady = checkSteady(*captured, "calibrate " + kind + " again"); !steady) {
        return steady.error();
    }
    if (Result<void> good = checkAgainst(*black, captured->signals, kind); !good) {
        return good.error();
    }
    proc::SampleInfo about = info(kind);
    about.truthSpec.clear();
    finish(about, *captured);
    const std::size_t states = captured->raw.states.size();
    const std::vector<Radians> angles = bench_.rig.identify().ledAngles;
    const std::optional<double> warmth = celsius();
    const auto kept = whileAlive([&]() -> Result<CalibrationRecord> {
        const Result<std::string> raw = rawBytes(about, std::move(captured->raw.states));
        if (!raw) return raw.error();
        const Result<std::string> bytes = encodeReference({about, captured->signals}, angles);
        if (!bytes) return bytes.error();
        return bench_.store.addCalibration({.rig = serial_,
                                            .kind = kind,
                                            .dateUtc = about.dateUtc,
                                            .profileHash = bench_.profile.hash,
                                            .celsius = warmth},
                                           {.file = *bytes, .raw = *raw});
    });
    if (!kept) return kept.error();
    return Json{{"schema", "gonio/calibrate-" + kind + "/1"},
                {"rig", serial_},
                {"states", states},
                {"chi_square_per_freedom", captured->chiSquarePerFreedom},
                {"rig_seconds", about.rigSeconds},
                {"compute_seconds", about.computeSeconds},
                {"file", kept->file.string()}};
}

/// Median over the cells of how bright it is now over how bright it was.
double medianRatio(const proc::CellSignal& now, const proc::CellSignal& then) {
    std::vector<double> ratios;
    for (std::size_t cell = 0; cell < now.size(); ++cell) {
        if (now.present(cell) && then.present(cell) && then.signal[cell] > 0) {
            ratios.push_back(now.signal[cell] / then.signal[cell]);
        }
    }
    return ratios.empty() ? std::nan("") : median(std::move(ratios));
}

Result<Json> JobRun::verifyWhite() {
    if (Result<void> placed = expectPlaced("white"); !placed) return placed.error();
    const Result<ReferenceRecord> white = reference("white");
    if (!white) return white.error();
    const Result<Captured> captured = capture(kVerifyBracket, kDarkFrames);
    if (!captured) return captured.error();
    Json states = Json::array();
    double worst = 0;
    std::string worstState;
    for (std::size_t led = 0; led < leds(); ++led) {
        for (Band band : kBands) {
            const double ratio =
                medianRatio(captured->signals[led][index(band)], white->signals[led][index(band)]);
            states.push_back({{"led", led}, {"band", std::string(letter(band))}, {"ratio", ratio}});
            const std::string state = stateName({static_cast<int>(led), band});
            if (std::isnan(ratio)) {
                return Error{ErrorKind::Quality,
                             state + ": no cell was seen both now and when white was calibrated"};
            }
            if (std::abs(ratio - 1) <= worst) continue;
            worst = std::abs(ratio - 1);
            worstState = state;
        }
    }
    if (worst > request_.limit) {
        return Error{ErrorKind::Quality,
                     worstState + ": white has changed by " + fixed(100 * worst, 2) +
                         " % since it was calibrated, at most " + fixed(100 * request_.limit, 2) +
                         " % was allowed; clean it, wait for the rig to warm up, or run: gonio "
                         "calibrate white"};
    }
    return Json{{"schema", "gonio/verify-white/1"},
                {"rig", serial_},
                {"calibrated", white->info.dateUtc},
                {"worst_change", worst},
                {"limit", request_.limit},
                {"states", states},
                {"rig_seconds", onRig_.elapsed().count()}};
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

Result<SampleRecord> JobRun::keep(const std::string& name,
                                  const proc::SampleSet& set,
                                  std::vector<proc::RawState> states) {
    const Result<std::string> raw = rawBytes(set.info, std::move(states));
    if (!raw) return raw.error();
    const Result<std::string> bytes = proc::encodeGonio(set);
    if (!bytes) return bytes.error();
    auto kept = bench_.store.addSample(
        {.name = name, .rig = serial_, .dateUtc = set.info.dateUtc, .session = bench_.session},
        {.file = *bytes, .raw = *raw});
    if (!kept) return kept.error();
    if (!kept->movedTo.empty()) {
        log::warning("sample '" + name + "' was there; it is kept as '" + kept->movedTo + "'");
    }
    return std::move(kept->sample);
}

/// Looked for before the rig is asked for anything.
Result<BackingEvidence> JobRun::backingEvidence() const {
    BackingEvidence evidence{.backing = request_.backing, .other = {}};
    if (request_.against.empty()) return evidence;
    const Result<SampleRecord> record = bench_.store.sample(request_.against);
    if (!record) return record.error();
    Result<proc::SampleSet> other = proc::readGonio(record->file);
    if (!other) return other.error();
    evidence.other = std::move(*other);
    if (Result<void> good = checkOther(evidence); !good) return good.error();
    return evidence;
}

Result<JobRun::Loaded> JobRun::load() const {
    Result<CalibrationSet> set = newestSet(bench_.store, serial_);
    if (!set) return set.error();
    if (Result<void> good = checkValidity(*set); !good) return good.error();
    leaveOutStaleZero(*set, rigNow(), bench_.profile.validity);
    auto records = whileAlive([&] { return loadSet(bench_.store, *set); });
    if (!records) return records.error();
    for (const ReferenceRecord* one :
         {&records->black, &records->white, records->zero ? &*records->zero : &records->black}) {
        if (Result<void> fits = fitsThisRig(*one); !fits) return fits.error();
    }
    Result<References> certified = loadReferences(bench_.profile);
    if (!certified) return certified.error();
    return Loaded{std::move(*set), std::move(*records), std::move(*certified)};
}

Result<JobRun::Taken> JobRun::take(const RigReferences& references) {
    Bench bench = measuring();
    bench.glare = references.lens.glare;
    PlannedRun run(bench, references, request_.goal.plan());
    bench_.monitor.begin(run.steps());
    const Result<const proc::Plan*> plan = run.plan();
    if (!plan) return plan.error();
    bench_.monitor.begin(run.steps());
    Taken taken{
        .captured = {}, .planned = promiseOf(**plan), .achieved = {}, .wanted = (*plan)->wanted};
    bench_.monitor.planned(**plan);
    Result<Captured> captured = run.capture();
    if (!captured) return captured.error();
    bench_.monitor.captured();
    taken.captured = std::move(*captured);
    taken.achieved = {{"seconds", onRig_.elapsed().count()}};
    taken.achieved.update(toJson(run.achieved(taken.captured)));
    return taken;
}

Result<Json> JobRun::plan() {
    const Result<Loaded> loaded = load();
    if (!loaded) return loaded.error();
    Bench bench = measuring();
    const RigReferences references =
        referencesOf(loaded->records, loaded->certified, bench_.profile);
    PlannedRun run(bench, references, request_.goal.plan());
    bench_.monitor.begin(run.steps());
    const Result<const proc::Plan*> plan = run.plan();
    if (!plan) return plan.error();
    if (Result<void> dark = bench_.rig.darken(); !dark) return dark.error();
    bench_.monitor.captured();
    Json document{{"schema", "gonio/plan/1"}, {"rig", serial_}, {"goal", request_.goal.name()}};
    document.update(toJson(**plan));
    document["rig_seconds"] = onRig_.elapsed().count();
    return document;
}

Result<Json> JobRun::measure() {
    const Result<Loaded> loaded = load();
    if (!loaded) return loaded.error();
    const RigReferences references =
        referencesOf(loaded->records, loaded->certified, bench_.profile);
    const Result<BackingEvidence> backing = backingEvidence();
    if (!backing) return backing.error();
    Result<Taken> taken = take(references);
    if (!taken) return taken.error();
    Captured* const captured = &taken->captured;

    proc::SampleInfo about = info(request_.name);
    about.effort = request_.goal.name();
    about.requestedUncertainty = taken->wanted;
    about.referenceCertificate = loaded->certified.white->certificate().citation;
    about.calibrationId = loaded->set.id();
    finish(about, *captured);
    const std::vector<Radians> angles = bench_.rig.identify().ledAngles;
    proc::SampleSet sample;
    const auto kept = whileAlive([&]() -> Result<SampleRecord> {
        const Stopwatch calibrating(bench_.computer);
        sample = calibrateSample(captured->signals, angles, references, about);
        judgeCapture(sample, *captured, references);
        judgeTable(sample);
        judgeBacking(sample, *backing);
        sample.info.computeSeconds += calibrating.elapsed().count();
        const Result<void> good = accepted(sample, request_.force);
        if (good) return keep(request_.name, sample, std::move(captured->raw.states));
        const std::string aside = request_.name.substr(0, kLongestRefused) + ".refused";
        const auto refused = keep(aside, sample, std::move(captured->raw.states));
        if (!refused) return refused.error();
        return Error{good.error().kind, good.error().message + "; it is kept as '" + aside + "'"};
    });
    if (!kept) return kept.error();
    return Json{{"schema", "gonio/measure/1"},
                {"name", request_.name},
                {"file", kept->file.string()},
                {"raw", kept->raw.string()},
                {"effort", sample.info.effort},
                {"calibration", loaded->set.id()},
                {"measured_cells", measuredCells(sample)},
                {"median_relative_uncertainty", sample.info.achievedUncertainty.value_or(0)},
                {"chi_square_per_freedom", captured->chiSquarePerFreedom},
                {"planned", taken->planned},
                {"achieved", taken->achieved},
                {"qc", Json::parse(sample.info.qcVerdicts)},
                {"rig_seconds", sample.info.rigSeconds},
                {"compute_seconds", sample.info.computeSeconds}};
}

Result<Json> run(JobRun& job, JobKind kind) {
    switch (kind) {
        case JobKind::CalibrateMirror: return job.calibrateMirror();
        case JobKind::CalibrateBlack: return job.calibrateTile("black");
        case JobKind::CalibrateWhite: return job.calibrateTile("white");
        case JobKind::CalibrateZero: return job.calibrateTile("zero");
        case JobKind::VerifyWhite: return job.verifyWhite();
        case JobKind::Measure: return job.measure();
        case JobKind::Plan: return job.plan();
        case JobKind::Recalibrate: break;  // needs no rig
    }
    return Error{ErrorKind::Internal, "no such job"};
}

}  // namespace

Result<std::string> runJob(const JobBench& bench, const JobRequest& request) {
    JobRun job(bench, request);
    const Result<Json> document = run(job, request.kind);
    if (!document) return document.error();
    return dump(*document);
}

}  // namespace gonio::daemon
