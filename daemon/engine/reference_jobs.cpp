#include "daemon/engine/reference_jobs.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/rig_records.h"
#include "proc/core/median.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDarkFrames = 4;
// White multiplies into every later sample, so it is averaged longest: 16 frames at least. Its 320
// us leave a tile just unsaturated; 1.28 ms add light where the view is dim.
constexpr BracketPlan kWhiteBracket{.frames = 8, .dim = false, .longest = 3, .first = 2};
constexpr BracketPlan kBlackBracket{.frames = 8, .dim = false, .longest = -1, .first = 5};
// A check of the white asks for a mean over all cells: one frame is plenty.
constexpr BracketPlan kVerifyBracket{.frames = 1, .dim = false, .longest = 2, .first = 2};

/// How this rig's pictures are seen now.
Result<View> newestView(const JobRun& run) {
    const Result<CalibrationRecord> mirror = newestOf(run.bench().store, run.serial(), "mirror");
    if (!mirror) return mirror.error();
    return viewOf(*mirror, run.newestGood("flat"), run.newestGood("leds"));
}

/// Takes all states of what lies under the rig, which is dark afterwards.
Result<Captured> capture(const JobRun& run,
                         const View& view,
                         const BracketPlan& plan,
                         int darkFrames) {
    Bench bench = run.measuring();
    bench.glare = view.lens.glare;
    bench.corrections = view.corrections;
    run.bench().monitor.begin(placementSteps(bench));
    Result<Captured> captured = measurePlacement(bench, view.lens.fit.map, plan, darkFrames);
    if (!captured) return captured;
    if (Result<void> dark = run.bench().rig.darken(); !dark) return dark.error();
    run.bench().monitor.captured();
    return captured;
}

Result<void> placeMirror(const JobRun& run, const proc::Wedge& wedge) {
    const Result<bool> placed = run.bench().port.placeMirror(wedge);
    if (!placed) return placed.error();
    if (*placed) return {};
    return run.bench().monitor.ask("put the mirror on the wedge of " +
                                   fixed(wedge.aboutX.degrees(), 0) + " degrees about x and " +
                                   fixed(wedge.aboutY.degrees(), 0) + " degrees about y");
}

/// The newest, as this view has it.
Result<ReferenceRecord> reference(const JobRun& run, const std::string& kind, const View& view) {
    const Result<CalibrationRecord> record = newestOf(run.bench().store, run.serial(), kind);
    if (!record) return record.error();
    auto found = run.whileAlive([&] { return readReference(run.bench().store, *record, view); });
    if (!found) return found;
    if (Result<void> fits = run.fitsThisRig(*found); !fits) return fits.error();
    return found;
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

/// How far the cells differ from their median ratio beyond their noise: root mean square over the
/// cells, as of one of the two placements.
double textureOf(const proc::CellSignal& now, const proc::CellSignal& then, double ratio) {
    double sum = 0, cells = 0;
    for (std::size_t cell = 0; cell < now.size(); ++cell) {
        if (!now.present(cell) || !then.present(cell) || !(then.signal[cell] > 0)) continue;
        const double own = now.signal[cell] / then.signal[cell] / ratio - 1;
        const double noise = now.variance[cell] / std::pow(now.signal[cell], 2) +
                             then.variance[cell] / std::pow(then.signal[cell], 2);
        sum += own * own - noise;
        cells += 1;
    }
    return std::sqrt(std::max(sum, 0.0) / (2 * cells));
}

struct Largest {
    double value = 0;
    std::string state;

    void see(double one, const std::string& of) {
        if (one <= value) return;
        value = one;
        state = of;
    }
};

/// Quality error for a white that is not what it was, or, turned about its normal, not like itself.
Result<void> checkWhiteAgain(const JobRun& run,
                             const Largest& change,
                             const Largest& texture,
                             double perDirection) {
    constexpr double kSigmas = 2;
    const double limit = run.request().limit;
    if (change.value > limit) {
        return Error{ErrorKind::Quality,
                     change.state + ": white has changed by " + fixed(100 * change.value, 2) +
                         " % since it was calibrated, at most " + fixed(100 * limit, 2) +
                         " % was allowed; clean it, wait for the rig to warm up, or run: gonio "
                         "calibrate white"};
    }
    if (!run.request().turned || texture.value <= kSigmas * perDirection) return {};
    return Error{ErrorKind::Quality,
                 texture.state + ": turned, the white differs from itself by " +
                     fixed(100 * texture.value, 2) + " % (rms over the directions), and its " +
                     "certificate allows " + fixed(100 * perDirection, 2) +
                     " % per direction; it has a grain, or is stained: take another white"};
}

}  // namespace

Result<Json> calibrateMirror(const JobRun& run) {
    if (Result<void> placed = run.expectPlaced("mirror"); !placed) return placed.error();
    const Bench bench = run.measuring();
    run.bench().monitor.begin(mirrorSteps(bench));
    Result<LensRecord> lens =
        measureLens(bench, [&](const proc::Wedge& wedge) { return placeMirror(run, wedge); });
    if (!lens) return lens.error();
    if (Result<void> dark = run.bench().rig.darken(); !dark) return dark.error();
    run.bench().monitor.captured();
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
                                              ? reference(run, "black", *view)
                                              : Result<ReferenceRecord>(ReferenceRecord{});
    if (!black) return black.error();
    Result<Captured> captured =
        capture(run, *view, white ? kWhiteBracket : kBlackBracket, 2 * kDarkFrames);
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
        const Result<std::string> raw = rawBytes(about, std::move(captured->raw.states));
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
    const Result<Captured> captured = capture(run, *view, kWhiteBracket, 2 * kDarkFrames);
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

Result<Json> verifyWhite(const JobRun& run) {
    if (Result<void> placed = run.expectPlaced("white"); !placed) return placed.error();
    const Result<View> view = newestView(run);
    if (!view) return view.error();
    const Result<ReferenceRecord> white = reference(run, "white", *view);
    if (!white) return white.error();
    const Result<Captured> captured = capture(run, *view, kVerifyBracket, kDarkFrames);
    if (!captured) return captured.error();
    Json states = Json::array();
    Largest change, texture;
    for (std::size_t led = 0; led < run.leds(); ++led) {
        for (const Band band : kBands) {
            const proc::CellSignal& now = captured->signals[led][index(band)];
            const proc::CellSignal& then = white->signals[led][index(band)];
            const std::string state = stateName({static_cast<int>(led), band});
            const double ratio = medianRatio(now, then);
            if (std::isnan(ratio)) {
                return Error{ErrorKind::Quality,
                             state + ": no cell was seen both now and when white was calibrated"};
            }
            change.see(std::abs(ratio - 1), state);
            const double grain = textureOf(now, then, ratio);
            texture.see(grain, state);
            states.push_back({{"led", led},
                              {"band", std::string(letter(band))},
                              {"ratio", ratio},
                              {"texture", grain}});
        }
    }
    const Result<References> certified = loadReferences(run.profile());
    if (!certified) return certified.error();
    const double perDirection = certified->white->certificate().uPerDirection;
    if (Result<void> good = checkWhiteAgain(run, change, texture, perDirection); !good)
        return good.error();
    return Json{{"schema", "gonio/verify-white/1"},
                {"rig", run.serial()},
                {"calibrated", white->info.dateUtc},
                {"worst_change", change.value},
                {"limit", run.request().limit},
                {"turned", run.request().turned},
                {"texture", texture.value},
                {"certified_per_direction", perDirection},
                {"states", states},
                {"rig_seconds", run.onRig().count()}};
}

}  // namespace gonio::daemon
