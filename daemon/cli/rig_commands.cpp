// Commands that need a rig: calibrate mirror|black|white, and measure. Today's rig is the simulated
// one, in this process.

#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/progress.h"
#include "daemon/measurement.h"
#include "daemon/sim_bench.h"
#include "daemon/store_lock.h"
#include "driver/steady_clock.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kDarkFrames = 4;
// White multiplies into every later sample, so it is averaged longest: 16 frames at least. Its 320
// us leave a tile just unsaturated; 1.28 ms add light where the view is dim.
constexpr BracketPlan kWhiteBracket{.frames = 8, .dim = false, .longest = 3, .first = 2};
constexpr BracketPlan kBlackBracket{.frames = 8, .dim = false, .longest = -1, .first = 5};

std::string utcNow() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc)};
}

/// No session takes more captures; a session that is killed leaves this gap.
constexpr std::uint64_t kReservedSteps = 1 << 16;

/// An opened simulated rig with what the store knows of it, for this process alone. Its plan steps
/// are reserved at the beginning, so that no later session takes one of them again however this one
/// ends.
class RigSession {
public:
    static Result<std::unique_ptr<RigSession>> open(const CommonOptions& common,
                                                    const fs::path& profile) {
        Result<Store> store = Store::open(common.store);
        if (!store) return store.error();
        Result<StoreLock> lock = StoreLock::take(store->root());
        if (!lock) return lock.error();
        const Result<SimState> state = readSimState(*store);
        if (!state) return state.error();
        SimState reserved = *state;
        reserved.nextPlanStep += kReservedSteps;
        if (Result<void> kept = writeSimState(*store, reserved); !kept) return kept.error();
        Result<RigProfile> known = readProfile(profile.empty() ? defaultProfile() : profile);
        if (!known) return known.error();
        Result<std::unique_ptr<sim::InProcessDoor>> door =
            openSim(*state, *store, known->cameraUsb);
        if (!door) return door.error();
        auto rig = driver::Rig::open(**door, state->nextPlanStep);
        if (!rig) return rig.error();
        return std::unique_ptr<RigSession>(new RigSession(std::move(*store),
                                                          std::move(*lock),
                                                          *state,
                                                          std::move(*known),
                                                          std::move(*door),
                                                          std::move(*rig)));
    }
    ~RigSession() { (void)writeSimState(store, state); }
    RigSession(const RigSession&) = delete;
    RigSession& operator=(const RigSession&) = delete;

    [[nodiscard]] double rigSeconds() const { return onRig.elapsed().count(); }
    [[nodiscard]] Bench bench(Progress& progress) {
        return {.rig = rig,
                .profile = profile,
                .nextPlanStep = state.nextPlanStep,
                .clock = computer,
                .step = [&progress](const std::string& what) -> Result<void> {
                    progress.step(what);
                    return {};
                }};
    }
    /// What every file of this session says of its origin.
    [[nodiscard]] proc::SampleInfo info(const std::string& name) const {
        proc::SampleInfo info;
        info.name = name;
        info.rigSerial = state.serial;
        info.profileHash = profile.hash;
        info.dateUtc = utcNow();
        info.softwareVersion = "gonio " GONIO_VERSION;
        info.extra["seed"] = std::to_string(state.seed);
        info.extra["rig"] = "simulated, systematic errors of the references: " + state.systematic;
        return info;
    }

    Store store;
    StoreLock lock;
    SimState state;
    RigProfile profile;
    driver::SteadyClock computer;
    std::unique_ptr<sim::InProcessDoor> door;
    driver::Rig rig;

private:
    RigSession(Store s,
               StoreLock l,
               SimState st,
               RigProfile p,
               std::unique_ptr<sim::InProcessDoor> d,
               driver::Rig r)
        : store(std::move(s)),
          lock(std::move(l)),
          state(std::move(st)),
          profile(std::move(p)),
          door(std::move(d)),
          rig(std::move(r)),
          onRig(door->clock()) {}
    Stopwatch onRig;
};

std::map<std::string, std::string> rawInfo(const proc::SampleInfo& info) {
    return {{"name", info.name},
            {"rig_serial", info.rigSerial},
            {"profile_hash", info.profileHash},
            {"date", info.dateUtc},
            {"software", info.softwareVersion}};
}

Result<std::string> rawBytes(const proc::SampleInfo& info, std::vector<proc::RawState> states) {
    return proc::encodeGraw({.info = rawInfo(info), .states = std::move(states)});
}

void finish(proc::SampleInfo& info, const RigSession& session, const Captured& captured) {
    info.rigSeconds = session.rigSeconds();
    info.computeSeconds = captured.compute.count();
    info.extra["chi_square_per_freedom"] = shortest(captured.chiSquarePerFreedom);
}

void print(const CommonOptions& common, const Json& json, const std::string& line) {
    if (common.json) {
        std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
    } else if (!common.quiet) {
        std::cout << line << "\n";
    }
}

Error notPlaced(const RigSession& session, const std::string& reference) {
    return {ErrorKind::Quality,
            "under the rig lies '" + session.state.placed + "'; place the " + reference +
                " first: gonio sim place " + reference};
}

/// A reference is of this rig's LEDs, or its cells would be taken for others'.
Result<void> checkLeds(const ReferenceRecord& reference, const RigSession& session) {
    const std::size_t leds = session.rig.identify().ledAngles.size();
    if (reference.signals.size() == leds) return {};
    return Error{ErrorKind::Quality,
                 "the " + reference.info.name + " reference of " + session.state.serial + " has " +
                     std::to_string(reference.signals.size()) + " LEDs, the rig " +
                     std::to_string(leds) + "; run: gonio calibrate " + reference.info.name};
}

Result<void> calibrateMirror(const CommonOptions& common, RigSession& session) {
    const Bench probe{
        session.rig, session.profile, session.state.nextPlanStep, session.computer, {}};
    Progress progress("mirror", mirrorSteps(probe), session.computer, !common.quiet);
    if (session.state.placed != "mirror") {
        return notPlaced(session, "mirror");
    }
    // The simulated rig's operator changes the wedge between the placements.
    const PlaceMirror place = [&](const proc::Wedge& wedge) -> Result<void> {
        session.door->device().place(
            {.role = sim::Role::Mirror, .surface = nullptr, .wedge = {wedge.aboutX, wedge.aboutY}});
        return {};
    };
    Result<LensRecord> lens = measureLens(session.bench(progress), place);
    if (!lens) return lens.error();
    lens->dateUtc = utcNow();
    const auto kept = session.store.addCalibration(
        {.rig = session.state.serial, .kind = "mirror", .dateUtc = lens->dateUtc},
        {.file = encodeLens(*lens)});
    if (!kept) return kept.error();
    print(common,
          {{"schema", "gonio/calibrate-mirror/1"},
           {"rig", session.state.serial},
           {"spots", lens->spots},
           {"rms_px", lens->fit.rmsPixels},
           {"worst_px", lens->fit.worstPixels},
           {"rig_seconds", session.rigSeconds()},
           {"file", kept->file.string()}},
          "lens map of " + session.state.serial + ": " + std::to_string(lens->spots) +
              " mirror spots, " + fixed(lens->fit.rmsPixels, 3) + " px rms, worst " +
              fixed(lens->fit.worstPixels, 3) + " px");
    return {};
}

Result<void> calibrateTile(const CommonOptions& common, RigSession& session, bool white) {
    const std::string name = white ? "white" : "black";
    if (session.state.placed != name) return notPlaced(session, name);
    const Result<LensRecord> lens = loadLens(session.store, session.state.serial);
    if (!lens) return lens.error();
    const Bench probe{
        session.rig, session.profile, session.state.nextPlanStep, session.computer, {}};
    Progress progress(name, placementSteps(probe), session.computer, !common.quiet);
    Result<Captured> captured = measurePlacement(session.bench(progress),
                                                 lens->fit.map,
                                                 white ? kWhiteBracket : kBlackBracket,
                                                 2 * kDarkFrames);
    if (!captured) return captured.error();
    if (white) {
        const Result<ReferenceRecord> black =
            loadReference(session.store, session.state.serial, "black");
        if (!black) return black.error();
        if (Result<void> fits = checkLeds(*black, session); !fits) return fits;
        if (Result<void> bright = checkWhite(captured->signals, black->signals); !bright)
            return bright;
    }
    proc::SampleInfo info = session.info(name);
    finish(info, session, *captured);
    const std::size_t states = captured->raw.states.size();
    const Result<std::string> raw = rawBytes(info, std::move(captured->raw.states));
    if (!raw) return raw.error();
    const Result<std::string> bytes =
        encodeReference({info, captured->signals}, session.rig.identify().ledAngles);
    if (!bytes) return bytes.error();
    const auto kept = session.store.addCalibration(
        {.rig = session.state.serial, .kind = name, .dateUtc = info.dateUtc},
        {.file = *bytes, .raw = *raw});
    if (!kept) return kept.error();
    print(common,
          {{"schema", "gonio/calibrate-" + name + "/1"},
           {"rig", session.state.serial},
           {"states", states},
           {"chi_square_per_freedom", captured->chiSquarePerFreedom},
           {"rig_seconds", info.rigSeconds},
           {"compute_seconds", info.computeSeconds},
           {"file", kept->file.string()}},
          name + " reference of " + session.state.serial + ": " + std::to_string(states) +
              " states in " + fixed(info.rigSeconds, 1) + " s on the rig");
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

}  // namespace

Result<void> calibrate(const CommonOptions& common, const CalibrateOptions& options) {
    const auto session = RigSession::open(common, options.profile);
    if (!session) return session.error();
    switch (options.reference) {
        case Reference::Mirror: return calibrateMirror(common, **session);
        case Reference::Black: return calibrateTile(common, **session, false);
        case Reference::White: return calibrateTile(common, **session, true);
    }
    return {};
}

Result<void> measure(const CommonOptions& common, const MeasureOptions& options) {
    const auto opened = RigSession::open(common, options.profile);
    if (!opened) return opened.error();
    RigSession& session = **opened;
    if (Result<void> good = checkSampleName(options.name); !good) return good;
    const Result<LensRecord> lens = loadLens(session.store, session.state.serial);
    if (!lens) return lens.error();
    const Result<ReferenceRecord> black =
        loadReference(session.store, session.state.serial, "black");
    if (!black) return black.error();
    const Result<ReferenceRecord> white =
        loadReference(session.store, session.state.serial, "white");
    if (!white) return white.error();
    for (const ReferenceRecord* reference : {&*black, &*white}) {
        if (Result<void> fits = checkLeds(*reference, session); !fits) return fits;
    }
    const Result<References> certified = loadReferences(session.profile);
    if (!certified) return certified.error();

    const Bench probe{
        session.rig, session.profile, session.state.nextPlanStep, session.computer, {}};
    Progress progress(options.name, placementSteps(probe), session.computer, !common.quiet);
    Result<Captured> captured = measurePlacement(
        session.bench(progress), lens->fit.map, sampleBracket(options.effort), kDarkFrames);
    if (!captured) return captured.error();
    proc::SampleInfo info = session.info(options.name);
    info.effort = name(options.effort);
    info.operatorNotes = options.notes;
    info.truthSpec = session.state.placed;
    info.referenceCertificate = certified->white->certificate().citation;
    info.calibrationId = session.state.serial + "/" + white->info.dateUtc;
    finish(info, session, *captured);
    const Stopwatch calibrating(session.computer);
    proc::SampleSet set = calibrateSample(captured->signals,
                                          session.rig.identify().ledAngles,
                                          {*lens, *white, *black, *certified, session.profile},
                                          std::move(info));
    set.info.computeSeconds += calibrating.elapsed().count();

    const Result<std::string> raw = rawBytes(set.info, std::move(captured->raw.states));
    if (!raw) return raw.error();
    const Result<std::string> bytes = proc::encodeGonio(set);
    if (!bytes) return bytes.error();
    const auto kept = session.store.addSample(
        {.name = options.name, .rig = session.state.serial, .dateUtc = set.info.dateUtc},
        {.file = *bytes, .raw = *raw});
    if (!kept) return kept.error();
    if (!kept->movedTo.empty()) {
        log::warning("sample '" + options.name + "' was there; it is kept as '" + kept->movedTo +
                     "'");
    }
    if (!options.output.empty()) {
        if (Result<void> copied = proc::writeFile(options.output, *bytes); !copied) return copied;
    }
    const int cells = measuredCells(set);
    const double achieved = set.info.achievedUncertainty.value_or(0);
    print(common,
          {{"schema", "gonio/measure/1"},
           {"name", options.name},
           {"file", kept->sample.file.string()},
           {"raw", kept->sample.raw.string()},
           {"effort", set.info.effort},
           {"measured_cells", cells},
           {"median_relative_uncertainty", achieved},
           {"chi_square_per_freedom", captured->chiSquarePerFreedom},
           {"rig_seconds", set.info.rigSeconds},
           {"compute_seconds", set.info.computeSeconds}},
          options.name + ": " + std::to_string(cells) + " BRDF samples, median uncertainty " +
              fixed(100 * achieved, 2) + " % (k = 1), " + fixed(set.info.rigSeconds, 1) +
              " s on the rig, " + fixed(set.info.computeSeconds, 1) + " s computing; " +
              kept->sample.file.string());
    return {};
}

}  // namespace gonio::daemon
