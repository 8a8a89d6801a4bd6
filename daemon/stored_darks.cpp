#include "daemon/stored_darks.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "daemon/capture_plan.h"
#include "daemon/rig_records.h"
#include "daemon/then_dark.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/plan/shared_choice.h"

namespace gonio::daemon {
namespace {

constexpr int kFrames = 32;
constexpr double kKelvin = 1;

std::vector<Microseconds> exposuresOf(const Bench& bench) {
    const proc::RigModel rig =
        rigModel(bench.rig.identify(), bench.profile, proc::SensorModel{}.celsius);
    std::set<Microseconds> all(bench.profile.exposures.begin(), bench.profile.exposures.end());
    for (const Seconds exposure : rig.exposures)
        all.insert(std::chrono::round<Microseconds>(exposure));
    for (const Seconds exposure : proc::pilotExposures(rig))
        all.insert(std::chrono::round<Microseconds>(exposure));
    return {all.begin(), all.end()};
}

Result<std::vector<proc::DarkFrame>> takeDarks(const Bench& bench) {
    if (const Result<Window> window = configureWindow(bench.rig); !window) return window.error();
    Sequencer sequencer(bench.rig, bench.profile, bench.nextPlanStep, bench.attendance);
    std::vector<KnownShot> shots;
    for (const Microseconds exposure : exposuresOf(bench))
        shots.push_back({.state = {}, .shot = {.exposure = exposure}, .frames = kFrames});
    std::vector<proc::DarkFrame> darks;
    proc::DarkAverage sums(bench.profile.noise);
    const Result<void> taken = sequencer.take(
        shots,
        {.frame = [&](std::size_t, const Frame& frame) { return sums.add(frame); },
         .done = [&](std::size_t shot) -> Result<void> {
             Result<proc::DarkFrame> mean = sums.mean();
             if (!mean) return mean.error();
             darks.push_back(std::move(*mean));
             const double ms = static_cast<double>(shots[shot].shot.exposure.count()) * 1e-3;
             return bench.step("dark frames of " + shortest(ms) + " ms");
         },
         .begin = [&](std::size_t) -> Result<void> {
             sums = proc::DarkAverage(bench.profile.noise);
             return {};
         }});
    if (!taken) return taken.error();
    return darks;
}

}  // namespace

int storedDarkSteps(const Bench& bench) { return static_cast<int>(exposuresOf(bench).size()); }

Result<std::vector<proc::DarkFrame>> measureDarks(const Bench& bench) {
    return thenDark(bench, takeDarks(bench));
}

std::optional<CalibrationRecord> darksAt(Store& store,
                                         std::optional<double> sensorCelsius,
                                         const RigNow& now,
                                         const ValidityLimits& limits) {
    auto all = store.calibrations();
    if (!all || !sensorCelsius) return std::nullopt;
    std::optional<CalibrationRecord> best;
    double nearest = kKelvin;
    for (CalibrationRecord& one : *all) {
        if (one.kind != "dark" || one.rig != now.serial || !one.celsius) continue;
        const double distance = std::abs(*one.celsius - *sensorCelsius);
        const bool closer =
            distance < nearest || (distance == nearest && (!best || best->id < one.id));
        if (!closer || !whyNot(one, now, limits).empty()) continue;
        nearest = distance;
        best = std::move(one);
    }
    return best;
}

Result<std::vector<proc::DarkFrame>> readDarks(const CalibrationRecord& record) {
    const Result<std::string> bytes = proc::readFile(record.file);
    if (!bytes) return bytes.error();
    return decodeDarks(*bytes, "dark calibration " + std::to_string(record.id));
}

}  // namespace gonio::daemon
