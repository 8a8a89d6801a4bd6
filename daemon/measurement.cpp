#include "daemon/measurement.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "daemon/alongside.h"
#include "daemon/black_check.h"
#include "daemon/finest_binning.h"
#include "daemon/gathering.h"
#include "daemon/glare_views.h"
#include "daemon/sample_pose.h"
#include "daemon/then_dark.h"
#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/optics/cell_grid.h"
#include "proc/optics/spot.h"
#include "proc/quality/seen_direction.h"
#include "proc/radiance/merge.h"
#include "proc/table/achieved.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPixelsPerDegree = 6.6;  // where the lens fit starts
constexpr Radians kUsableSpot = 75.3_deg;
constexpr int kMirrorFrames = 4;
constexpr double kWhiteOverBlack = 50;
constexpr const char* kDraws = "monte_carlo_draws";

Direction lightAt(Radians incidence) { return Direction::fromSpherical(incidence, Radians(0)); }

Result<proc::DarkLibrary> takeDarks(const Bench& bench, Sequencer& sequencer, int frames) {
    return sequencer.darks(frames, [&] { return bench.step("dark frames"); });
}

double medianSignal(const proc::CellSignal& signal) {
    std::vector<double> present;
    for (std::size_t cell = 0; cell < signal.size(); ++cell) {
        if (signal.present(cell)) present.push_back(signal.signal[cell]);
    }
    return median(std::move(present));
}

Json toJson(const proc::Budget& budget) {
    Json list = Json::array();
    for (const proc::BudgetComponent& component : budget) {
        list.push_back({{"name", component.name},
                        {"type", std::string(1, component.type)},
                        {"correlation", proc::name(component.correlation)},
                        {"median_relative", component.medianRelative},
                        {"size", component.size},
                        {"unit", component.unit},
                        {"sensitivity", component.sensitivity()},
                        {"freedom", component.freedom ? Json(*component.freedom) : Json()}});
    }
    return list;
}

Result<LensRecord> takeLens(const Bench& bench, const PlaceMirror& place) {
    const Result<Window> window = configureWindow(bench.rig);
    if (!window) return window.error();
    Sequencer sequencer(bench.rig, bench.profile, bench.nextPlanStep, bench.attendance);
    const Result<proc::DarkLibrary> darks = takeDarks(bench, sequencer, kMirrorFrames);
    if (!darks) return darks.error();
    const std::vector<Radians> leds = bench.rig.identify().ledAngles;
    std::vector<proc::MirrorSpot> spots;
    GlareViews glareViews(leds, bench);
    for (const proc::Wedge& wedge : proc::mirrorWedges()) {
        if (Result<void> dark = bench.rig.darken(); !dark) return dark.error();
        if (Result<void> placed = place(wedge); !placed) return placed.error();
        for (int led = 0; led < static_cast<int>(leds.size()); ++led) {
            const Direction light = lightAt(leds[static_cast<std::size_t>(led)]);
            const Result<void> on =
                bench.step("mirror " + fixed(wedge.aboutX.degrees(), 0) + "/" +
                           fixed(wedge.aboutY.degrees(), 0) + " LED " + std::to_string(led));
            if (!on) return on.error();
            if (proc::mirroredBy(wedge, light).theta() > kUsableSpot) continue;
            const auto frames = sequencer.expose({led, Band::G},
                                                 bench.profile.dimLevels.back(),
                                                 bench.profile.exposures.front(),
                                                 kMirrorFrames);
            if (!frames) return frames.error();
            const auto merged =
                proc::merge(*frames, Band::G, *darks, bench.profile.noise, bench.profile.response);
            if (!merged) return merged.error();
            const Result<proc::Spot> spot = proc::findSpot(*merged);
            if (!spot) return spot.error();
            spots.push_back({.wedge = wedge, .light = light, .at = spot->at, .sigma = spot->sigma});
        }
        if (Result<void> on = glareViews.take(wedge, sequencer, *darks); !on) return on.error();
    }
    bench.attendance.captured();
    const proc::SensorPoint middle{window->x + 0.5 * window->size.width,
                                   window->y + 0.5 * window->size.height};
    Result<proc::LensFit> fit =
        proc::fitLens(spots, middle, kPixelsPerDegree, bench.profile.wedgeTolerance);
    if (!fit) return fit.error();
    const auto glare =
        alongside(bench.rig, bench.attendance.alive, [&] { return glareViews.spread(fit->map); });
    if (!glare) return glare.error();
    return LensRecord{.fit = std::move(*fit),
                      .spots = static_cast<int>(spots.size()),
                      .dateUtc = {},
                      .glare = *glare};
}

Result<Captured> capturePlacement(const Bench& bench,
                                  const proc::LensMap& lens,
                                  const BracketPlan& plan,
                                  int darkFrames) {
    const Result<Window> window = configureWindow(bench.rig);
    if (!window) return window.error();
    if (Result<void> fit = fits(bench.corrections, *window); !fit) return fit.error();
    Sequencer sequencer(bench.rig, bench.profile, bench.nextPlanStep, bench.attendance);
    Result<proc::DarkLibrary> darks = takeDarks(bench, sequencer, darkFrames);
    if (!darks) return darks.error();
    const Stopwatch preparing(bench.clock);
    const auto binning = alongside(
        bench.rig, bench.attendance.alive, [&] { return proc::Binning(lens, *window, kField); });
    if (!binning) return binning.error();
    const auto glare = alongside(bench.rig, bench.attendance.alive, [&] {
        return proc::GlareFilter(bench.glare.value_or(proc::GlareSpread{}), lens, *window, kField);
    });
    if (!glare) return glare.error();
    const Seconds prepared = preparing.elapsed();
    Gathering gathering(bench.rig,
                        bench.attendance,
                        {.darks = *darks,
                         .binning = *binning,
                         .glare = *glare,
                         .corrections = bench.corrections,
                         .profile = bench.profile,
                         .clock = bench.clock});
    const std::vector<State> states = sequencer.states();
    for (std::size_t i = 0; i < states.size(); ++i) {
        const auto then = i + 1 < states.size() ? std::optional(states[i + 1]) : std::nullopt;
        const Result<void> taken =
            sequencer.bracket(states[i],
                              plan,
                              {.frame = [&](const Frame& frame) { return gathering.add(frame); },
                               .begin = [&]() -> Result<void> {
                                   gathering.begin(states[i]);
                                   return {};
                               }},
                              then);
        if (!taken) return taken.error();
        if (!then) bench.attendance.captured();
        if (Result<void> on = gathering.end(); !on) return on.error();
        if (Result<void> on = bench.step(stateName(states[i])); !on) return on.error();
    }
    Result<Captured> captured = gathering.finish();
    if (!captured) return captured;
    captured->compute += prepared;
    captured->oddFrames = sequencer.oddFrames();
    captured->freshDarks = *darks;
    captured->darks = std::move(*darks);
    return captured;
}

/// Of each cell: standard uncertainty of where it lies, per axis; half a turn beyond the field.
using CellAngles = std::vector<DirectionSpread>;

CellAngles overField(const std::function<DirectionSpread(const Direction&)>& uAngle) {
    CellAngles angles(proc::CellGrid::count(), DirectionSpread::even(Radians(kPi)));
    parallelFor(angles.size(), [&](IndexRange cells) {
        for (std::size_t cell = cells.begin; cell < cells.end; ++cell) {
            const Direction wo = proc::CellGrid::centre(cell);
            if (wo.theta() < kField) angles[cell] = uAngle(wo);
        }
    });
    return angles;
}

/// As if it lay flat, with the budgets of its states; `uAngle`: of each LED's cells.
proc::SampleSet asIfFlat(const PlacementSignals& signals,
                         const std::vector<Radians>& ledAngles,
                         const RigReferences& references,
                         const std::vector<CellAngles>& uAngle,
                         const proc::MonteCarlo& monteCarlo) {
    const int spots = references.lens.spots;
    proc::RigUncertainty rig{
        .angle = {},
        .ledDrift = references.profile.ledDrift,
        .exposureRatio = references.profile.exposureRatio,
        .linearity = references.profile.linearity,
        .angleFreedom = 2.0 * spots - static_cast<double>(proc::LensMap::kParameters)};
    proc::SampleSet set;
    Json budgets = Json::array();
    for (std::size_t led = 0; led < signals.size(); ++led) {
        proc::LedTable table{.incidence = ledAngles[led], .bands = {}};
        rig.angle = uAngle[led];
        for (Band band : kBands) {
            const std::size_t b = index(band);
            rig.ledDrift = std::hypot(references.profile.ledDrift, references.uMonitor[b]);
            proc::Calibrated calibrated =
                proc::calibrate(signals[led][b],
                                referencesOf(references, {static_cast<int>(led), band}),
                                lightAt(ledAngles[led]),
                                band,
                                rig,
                                monteCarlo);
            budgets.push_back({{"led", led},
                               {"band", std::string(letter(band))},
                               {"monte_carlo_cells", calibrated.propagated},
                               {"components", toJson(calibrated.budget)}});
            table.bands[b] = std::move(calibrated.samples);
        }
        set.leds.push_back(std::move(table));
    }
    set.info.budgetJson = budgets.dump(-1, ' ', false, Json::error_handler_t::replace);
    return set;
}

}  // namespace

/// Binned only by a rig that sends no other pictures: then as little as it can.
Result<Window> configureWindow(driver::Rig& rig) {
    const driver::RigInfo info = rig.identify();
    const int side = std::min(info.sensor.width, info.sensor.height);
    const Window window{.x = (info.sensor.width - side) / 2,
                        .y = (info.sensor.height - side) / 2,
                        .size = {side, side},
                        .binning = finestBinning(info.limits)};
    const Result<void> done = rig.configure(window);
    if (!done) return done.error();
    return window;
}

int mirrorSteps(const Bench& bench) {
    return static_cast<int>(bench.profile.exposures.size() +
                            proc::mirrorWedges().size() * bench.rig.identify().ledAngles.size()) +
           GlareViews(bench.rig.identify().ledAngles, bench).count();
}

int placementSteps(const Bench& bench) {
    return static_cast<int>(bench.profile.exposures.size() +
                            kBands.size() * bench.rig.identify().ledAngles.size());
}

Result<LensRecord> measureLens(const Bench& bench, const PlaceMirror& place) {
    return thenDark(bench, takeLens(bench, place));
}

Result<Captured> measurePlacement(const Bench& bench,
                                  const proc::LensMap& lens,
                                  const BracketPlan& plan,
                                  int darkFrames) {
    return thenDark(bench, capturePlacement(bench, lens, plan, darkFrames));
}

Result<void> checkWhite(const PlacementSignals& white, const PlacementSignals& black) {
    for (std::size_t led = 0; led < white.size(); ++led) {
        for (Band band : kBands) {
            const double bright = medianSignal(white[led][index(band)]);
            const double dark = medianSignal(black[led][index(band)]);
            if (bright > kWhiteOverBlack * std::abs(dark)) continue;
            return Error{ErrorKind::Quality,
                         stateName({static_cast<int>(led), band}) + ": white is only " +
                             fixed(bright / dark, 1) +
                             " times as bright as black; is the white reference placed?"};
        }
    }
    return {};
}

Result<void> checkZero(const PlacementSignals& zero, const PlacementSignals& black) {
    for (std::size_t led = 0; led < zero.size(); ++led) {
        for (Band band : kBands) {
            if (medianSignal(zero[led][index(band)]) < medianSignal(black[led][index(band)])) {
                continue;
            }
            return Error{ErrorKind::Quality,
                         stateName({static_cast<int>(led), band}) +
                             ": the zero reference is not darker than the black; is the light trap "
                             "placed, and clean?"};
        }
    }
    return {};
}

proc::References referencesOf(const RigReferences& references, State state) {
    const auto led = static_cast<std::size_t>(state.led);
    const std::size_t b = index(state.band);
    const bool trap = references.zero != nullptr;
    const ReferenceRecord& lower = trap ? *references.zero : references.black;
    return {.whiteSignal = references.white.signals[led][b],
            .blackSignal = lower.signals[led][b],
            .white = *references.certified.white,
            .black = trap ? *references.certified.zero : *references.certified.black};
}

proc::SampleSet calibrateSample(const PlacementSignals& signals,
                                const std::vector<Radians>& ledAngles,
                                const RigReferences& references,
                                proc::SampleInfo info,
                                const proc::MonteCarlo& monteCarlo) {
    constexpr Radians kTypicalView = 40_deg;
    const proc::LensFit& lens = references.lens.fit;
    const proc::DirectionUncertainty uAngle(lens);
    const std::vector<CellAngles> ofMap(signals.size(), overField(uAngle));
    proc::SampleSet set = asIfFlat(signals, ledAngles, references, ofMap, monteCarlo);
    const Radians uLens = uAngle(Direction::fromSpherical(kTypicalView, Radians(0))).perAxis();
    std::optional<proc::TiltEstimate> tilt = proc::estimateTilt(set, uLens);
    const PoseLimits& limits = references.profile.quality.pose;
    if (worthCorrecting(tilt, limits)) {
        const proc::SeenDirection seen(lens, ledAngles, *tilt);
        std::vector<CellAngles> ofLobes;
        for (std::size_t led = 0; led < signals.size(); ++led) {
            ofLobes.push_back(
                overField([&](const Direction& wo) { return seen.uncertainty(led, wo); }));
        }
        set = asIfFlat(signals, ledAngles, references, ofLobes, monteCarlo);
        tilt->waves = seen.wavesBeyondTheMap(*tilt);
    }
    info.budgetJson = std::move(set.info.budgetJson);
    noteBlackCheck(checkBlack(references, ledAngles), info);
    set.info = std::move(info);
    proc::SampleSet flat = referredToItsNormal(std::move(set), tilt, limits);
    flat.info.achievedUncertainty = proc::achievedUncertainty(flat);
    return flat;
}

void noteDraws(int draws, proc::SampleInfo& info) { info.extra[kDraws] = std::to_string(draws); }

proc::MonteCarlo drawsOf(const proc::SampleInfo& info) {
    const auto said = info.extra.find(kDraws);
    if (said == info.extra.end()) return {};
    const auto draws = parseInteger(said->second);
    return {.draws =
                draws && *draws > 0 && std::in_range<int>(*draws) ? static_cast<int>(*draws) : 0};
}

}  // namespace gonio::daemon
