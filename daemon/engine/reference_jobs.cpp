#include "daemon/engine/reference_jobs.h"

#include <nlohmann/json.hpp>

#include "daemon/engine/reference_capture.h"
#include "daemon/rig_records.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kReferenceDarks = 8;
// White multiplies into every later sample, so it is averaged longest: 16 frames at least. Its 320
// us leave a tile just unsaturated; 1.28 ms add light where the view is dim.
constexpr BracketPlan kWhiteBracket{.frames = 8, .dim = false, .longest = 3, .first = 2};
constexpr BracketPlan kBlackBracket{.frames = 8, .dim = false, .longest = -1, .first = 5};

Result<void> placeMirror(const JobRun& run, const proc::Wedge& wedge) {
    const Result<bool> placed = run.bench().port.placeMirror(wedge);
    if (!placed) return placed.error();
    if (*placed) return {};
    return run.bench().monitor.ask("put the mirror on the wedge of " +
                                   fixed(wedge.aboutX.degrees(), 0) + " degrees about x and " +
                                   fixed(wedge.aboutY.degrees(), 0) + " degrees about y");
}

/// Quality error for light that changed in the middle of a bracket.
Result<void> checkSteady(const Captured& captured, const std::string& whatToDo) {
    if (captured.lightSteps.empty()) return {};
    return Error{ErrorKind::Quality,
                 "the light changed: " + described(captured.lightSteps) + "; " + whatToDo};
}

/// A white is held against the black, and so is a light trap: it must be darker.
Result<void> checkAgainst(const ReferenceRecord& black,
                          const PlacementSignals& signals,
                          const std::string& kind) {
    if (kind == "white") return checkWhite(signals, black.signals);
    return kind == "zero" ? checkZero(signals, black.signals) : Result<void>();
}

}  // namespace

Result<Json> calibrateMirror(const JobRun& run) {
    if (Result<void> placed = run.expectPlaced("mirror"); !placed) return placed.error();
    const Bench bench = run.measuring();
    run.bench().monitor.begin(mirrorSteps(bench));
    Result<LensRecord> lens =
        measureLens(bench, [&](const proc::Wedge& wedge) { return placeMirror(run, wedge); });
    if (!lens) return lens.error();
    lens->dateUtc = run.bench().utcNow();
    const std::optional<double> warmth = run.celsius();  // of a link that only this thread reads
    const auto kept = run.whileAlive([&] {
        return run.keep({.kind = "mirror", .dateUtc = lens->dateUtc, .celsius = warmth},
                        {.file = encodeLens(*lens)});
    });
    if (!kept) return kept.error();
    return Json{{"schema", "gonio/calibrate-mirror/1"},
                {"rig", run.serial()},
                {"spots", lens->spots},
                {"rms_px", lens->fit.rmsPixels},
                {"worst_px", lens->fit.worstPixels},
                {"glare_share", lens->glare ? Json(lens->glare->share()) : Json(nullptr)},
                {"glare_u_share", lens->glare ? Json(lens->glare->uShare) : Json(nullptr)},
                {"rig_seconds", run.onRig().count()},
                {"file", kept->file.string()}};
}

Result<Json> calibrateTile(const JobRun& run, const std::string& kind) {
    const bool white = kind == "white";
    if (Result<void> placed = run.expectPlaced(kind); !placed) return placed.error();
    // Looked for before minutes go into what would be refused without it.
    const Result<View> view = newestView(run);
    if (!view) return view.error();
    const Result<ReferenceRecord> black = kind != "black"
                                              ? storedReference(run, "black", *view)
                                              : Result<ReferenceRecord>(ReferenceRecord{});
    if (!black) return black.error();
    Result<Captured> captured =
        captureReference(run, *view, white ? kWhiteBracket : kBlackBracket, kReferenceDarks);
    if (!captured) return captured.error();
    if (Result<void> steady = checkSteady(*captured, "calibrate " + kind + " again"); !steady) {
        return steady.error();
    }
    if (Result<void> good = checkAgainst(*black, captured->signals, kind); !good) {
        return good.error();
    }
    proc::SampleInfo about = run.info(kind);
    about.truthSpec.clear();
    about.calibrationId = view->id;
    run.finish(about, *captured);
    const std::size_t states = captured->raw.states.size();
    const std::vector<Radians> angles = run.ledAngles();
    const std::optional<double> warmth = run.celsius();
    const auto kept = run.whileAlive([&]() -> Result<CalibrationRecord> {
        const Result<std::string> raw =
            rawBytes({.info = about, .leds = {}}, std::move(captured->raw.states));
        if (!raw) return raw.error();
        const Result<std::string> bytes = encodeReference({about, captured->signals}, angles);
        if (!bytes) return bytes.error();
        return run.keep({.kind = kind, .dateUtc = about.dateUtc, .celsius = warmth},
                        {.file = *bytes, .raw = *raw});
    });
    if (!kept) return kept.error();
    return Json{{"schema", "gonio/calibrate-" + kind + "/1"},
                {"rig", run.serial()},
                {"states", states},
                {"chi_square_per_freedom", captured->chiSquarePerFreedom},
                {"rig_seconds", about.rigSeconds},
                {"compute_seconds", about.computeSeconds},
                {"file", kept->file.string()}};
}

Result<Json> calibrateFlat(const JobRun& run) {
    if (Result<void> placed = run.expectPlaced("white"); !placed) return placed.error();
    Result<View> view = newestView(run);
    if (!view) return view.error();
    view->corrections = {};
    const Result<Captured> captured = captureReference(run, *view, kWhiteBracket, kReferenceDarks);
    if (!captured) return captured.error();
    if (Result<void> steady = checkSteady(*captured, "calibrate flat again"); !steady) {
        return steady.error();
    }
    const std::optional<double> warmth = run.celsius();
    const auto flat = run.whileAlive([&]() -> Result<proc::FlatField> {
        std::vector<const proc::MergedState*> pictures;
        for (const proc::RawState& state : captured->raw.states) pictures.push_back(&state.merged);
        return proc::flatField(pictures);
    });
    if (!flat) return flat.error();
    const auto kept = run.whileAlive([&]() -> Result<CalibrationRecord> {
        const Result<std::string> bytes = encodeFlat(*flat);
        if (!bytes) return bytes.error();
        return run.keep({.kind = "flat", .celsius = warmth}, {.file = *bytes});
    });
    if (!kept) return kept.error();
    return Json{{"schema", "gonio/calibrate-flat/1"},
                {"rig", run.serial()},
                {"spread", flat->spread},
                {"u_response", flat->uResponse},
                {"covered_pixels", flat->coveredPixels},
                {"rig_seconds", run.onRig().count()},
                {"file", kept->file.string()}};
}

}  // namespace gonio::daemon
