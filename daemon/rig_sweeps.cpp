#include "daemon/rig_sweeps.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "daemon/finest_binning.h"
#include "daemon/then_dark.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

constexpr int kExposures = 16, kPair = 2;
constexpr double kFill = 0.85;  // of the range, at the longest exposure
constexpr int kSide = 128;      // of the even part of the field, pixels
constexpr Microseconds kFirstLook{80}, kLongest{20'000};
constexpr double kLeastDn = 40;  // of the first look, above the dark
// Longer than an LED's chip needs to cool, and to warm up.
constexpr Microseconds kColdExposure{100'000}, kWarmExposure{100'000};
constexpr int kColdFrames = 60, kWarmFrames = 20, kWarmSteps = 2, kFramesOfEach = 4, kCycles = 4;
constexpr double kWarmLevelDn = 0.6;  // of full scale, that a warm-up aims at

Error tooDark(const std::string& what) {
    return {ErrorKind::Quality, what + "; is the white reference placed, and the rig seated?"};
}

/// Some 15 degrees from the normal and out of the plane of incidence: no shadow and no LED there,
/// and little fall of the light.
Result<Window> evenPart(driver::Rig& rig) {
    const driver::RigInfo about = rig.identify();
    if (const int finest = finestBinning(about.limits); finest != 1) {
        return Error{ErrorKind::Device,
                     "the rig sends means of " + std::to_string(finest) + " x " +
                         std::to_string(finest) +
                         " pixels only; its sensor and LEDs are calibrated by single ones"};
    }
    const Size sensor = about.sensor;
    constexpr int kOff = 96;
    const Window window{.x = (sensor.width - kSide) / 2,
                        .y = (sensor.height - kSide) / 2 + kOff,
                        .size = {kSide, kSide},
                        .binning = 1};
    if (Result<void> done = rig.configure(window); !done) return done.error();
    return window;
}

double meanDn(const Frame& frame) {
    double sum = 0;
    for (const std::uint16_t dn : frame.pixels.pixels()) sum += dn;
    return sum / static_cast<double>(frame.pixels.size().pixels());
}

/// DN per microsecond of what lies under the rig, at this level.
Result<double> brightness(Sequencer& sequencer, State state, double level, Microseconds exposure) {
    const auto frames = sequencer.expose(state, level, exposure, 1);
    if (!frames) return frames.error();
    const Frame& frame = frames->front();
    const double dn = meanDn(frame) - frame.blackLevel;
    if (dn < kLeastDn) return tooDark("only " + fixed(dn, 1) + " DN of light");
    return dn / (frame.exposure.seconds() * 1e6);
}

State middleState(const driver::Rig& rig) {
    return {static_cast<int>(rig.identify().ledAngles.size()) / 2, Band::G};
}

/// The frames of a sweep, pair by pair.
struct Sweep {
    std::vector<Frame> lit, dark;
};

Result<Sweep> takeSweep(const Bench& bench, Sequencer& sequencer, State state) {
    const Result<double> bright = brightness(sequencer, state, 1, kFirstLook);
    if (!bright) return bright.error();
    const double range = bench.profile.noise.fullScaleDn - bench.rig.identify().blackLevel;
    const double longest = kFill * range / *bright;
    if (longest > static_cast<double>(kLongest.count())) {
        return tooDark("full scale takes " + fixed(longest * 1e-3, 0) + " ms");
    }
    std::vector<KnownShot> shots;
    const auto list = [&](std::optional<State> of, int k) {
        const auto exposure = Microseconds(std::lround(longest * k / kExposures));
        const bool joins = !shots.empty() && shots.back().state == of;
        shots.push_back({.state = of,
                         .shot = {.level = 1, .exposure = exposure},
                         .frames = kPair,
                         .joins = joins});
    };
    for (int k = 1; k <= kExposures; ++k) list({}, k);
    for (int k = 1; k <= kExposures; ++k) list(state, k);
    for (int k = kExposures; k >= 1; --k) list(state, k);
    Sweep sweep;
    const Result<void> taken = sequencer.take(
        shots,
        {.frame = [&](std::size_t shot, Frame&& frame) -> Result<void> {
             (shots[shot].state ? sweep.lit : sweep.dark).push_back(std::move(frame));
             return {};
         },
         .done =
             [&](std::size_t shot) {
                 return bench.step(shots[shot].state ? "exposures" : "dark frames");
             },
         .begin = [&](std::size_t shot) -> Result<void> {
             (shots[shot].state ? sweep.lit : sweep.dark).clear();
             return {};
         }});
    if (!taken) return taken.error();
    return sweep;
}

/// `noise`: the data sheet's, of which gain and read noise are found anew.
Result<SensorRecord> sensorOf(const std::vector<Frame>& lit,
                              const std::vector<Frame>& dark,
                              Band band,
                              proc::SensorNoise noise) {
    std::vector<proc::FlatPair> pairs;
    for (const std::vector<Frame>* frames : {&dark, &lit}) {
        for (std::size_t i = 0; i + 1 < frames->size(); i += kPair)
            pairs.push_back({&(*frames)[i], &(*frames)[i + 1]});
    }
    auto transfer = proc::photonTransfer(pairs, noise);
    if (!transfer) return transfer.error();
    noise.electronsPerDn = transfer->electronsPerDn;
    noise.readNoiseElectrons = transfer->readNoiseElectrons;
    proc::DarkLibrary darks;
    for (std::size_t i = 0; i + 1 < dark.size(); i += kPair) {
        auto mean = proc::averageDark(std::span(dark).subspan(i, kPair), noise);
        if (!mean) return mean.error();
        darks.add(std::move(*mean));
    }
    auto sweep = proc::sweepPoints(lit, band, darks, noise);
    if (!sweep) return sweep.error();
    auto linearity = proc::fitLinearity(*sweep, lit.front().blackLevel);
    if (!linearity) return linearity.error();
    return SensorRecord{.transfer = *transfer,
                        .linearity = std::move(*linearity),
                        .sweep = std::move(*sweep),
                        .celsius = lit.front().celsius[Frame::Sensor],
                        .dateUtc = {}};
}

Result<SensorRecord> takeSensor(const Bench& bench) {
    if (Result<Window> window = evenPart(bench.rig); !window) return window.error();
    Sequencer sequencer(bench.rig, bench.profile, bench.nextPlanStep, bench.attendance);
    const State state = middleState(bench.rig);
    const Result<Sweep> sweep = takeSweep(bench, sequencer, state);
    if (!sweep) return sweep.error();
    return sensorOf(sweep->lit, sweep->dark, state.band, bench.profile.noise);
}

/// One frame of a warm-up, without uncertainty of the dark: it is common to all.
Result<proc::WarmUpPoint> pointOf(const Frame& frame, Band band, const proc::SensorNoise& noise) {
    if (!frame.celsius[Frame::LedBoard]) {
        return Error{ErrorKind::Quality, "the rig tells no temperature of its LED board"};
    }
    const double pixels = static_cast<double>(frame.pixels.size().pixels());
    const double seconds = frame.exposure.seconds();
    const double electrons = (meanDn(frame) - frame.blackLevel) * noise.electronsPerDn;
    const std::size_t b = index(band);
    return proc::WarmUpPoint{
        .signal = electrons / seconds,
        .u = std::sqrt(noise.variance(electrons, seconds) / pixels) / seconds,
        .current = (frame.currentMinMilliamp[b] + frame.currentMaxMilliamp[b]) / 2,
        .celsius = *frame.celsius[Frame::LedBoard]};
}

/// Of the frames of one capture: what the LED wanders by they share, so that they are one point.
proc::WarmUpPoint meanOf(const std::vector<proc::WarmUpPoint>& frames, double time) {
    proc::WarmUpPoint mean{.signal = 0, .u = 0, .current = 0, .celsius = 0, .time = time};
    const auto n = static_cast<double>(frames.size());
    for (const proc::WarmUpPoint& frame : frames) {
        mean.signal += frame.signal / n;
        mean.u += frame.u / (n * std::sqrt(n));
        mean.current += frame.current / n;
        mean.celsius += frame.celsius / n;
    }
    return mean;
}

/// The exposure is short, so that full level does not saturate; what warms the LED is how long it
/// is lit, in frames that are taken and thrown away.
Result<std::vector<proc::WarmUpPoint>> warmUp(const Bench& bench,
                                              Sequencer& sequencer,
                                              State state) {
    const Result<double> bright = brightness(sequencer, state, 1, kFirstLook);
    if (!bright) return bright.error();
    const double aim = kWarmLevelDn * bench.profile.noise.fullScaleDn / *bright;
    const Microseconds exposure(std::lround(std::min(aim, static_cast<double>(kLongest.count()))));
    std::vector<KnownShot> shots;
    std::vector<bool> looked;  // of each shot: the others warm and cool
    const auto list = [&](KnownShot shot, bool isLooked) {
        shot.joins = shot.state.has_value();  // each cycle begins in the dark
        shots.push_back(shot);
        looked.push_back(isLooked);
    };
    const KnownShot cool{.state = {}, .shot = {.exposure = kColdExposure}, .frames = kColdFrames};
    const KnownShot warm{
        .state = state, .shot = {.exposure = kWarmExposure}, .frames = kWarmFrames};
    const KnownShot see{.state = state, .shot = {.exposure = exposure}, .frames = kFramesOfEach};
    for (int cycle = 0; cycle < kCycles; ++cycle) {
        list(cool, false);
        list(see, true);
        for (int i = 0; i < kWarmSteps; ++i) {
            list(warm, false);
            list(see, true);
        }
    }
    std::vector<proc::WarmUpPoint> points, look;
    const Result<void> taken =
        sequencer.take(shots,
                       {.frame = [&](std::size_t shot, const Frame& frame) -> Result<void> {
                            if (!looked[shot]) return {};
                            const auto point = pointOf(frame, state.band, bench.profile.noise);
                            if (!point) return point.error();
                            look.push_back(*point);
                            return {};
                        },
                        .done =
                            [&](std::size_t shot) {
                                if (!look.empty())
                                    points.push_back(meanOf(look, static_cast<double>(shot)));
                                look.clear();
                                return bench.step("warm-up in " + std::string(letter(state.band)));
                            },
                        .begin = [&](std::size_t shot) -> Result<void> {
                            const auto first = static_cast<double>(shot);
                            std::erase_if(points, [=](const auto& p) { return p.time >= first; });
                            look.clear();
                            return {};
                        }});
    if (!taken) return taken.error();
    return points;
}

Result<proc::LedMonitor> takeWarmUp(const Bench& bench) {
    if (Result<Window> window = evenPart(bench.rig); !window) return window.error();
    Sequencer sequencer(bench.rig, bench.profile, bench.nextPlanStep, bench.attendance);
    proc::LedMonitor monitor;
    for (const Band band : kBands) {
        const State state{middleState(bench.rig).led, band};
        auto points = warmUp(bench, sequencer, state);
        if (!points) return points.error();
        double milliamp = 0;
        for (const proc::WarmUpPoint& point : *points)
            milliamp += point.current / static_cast<double>(points->size());
        monitor.fullMilliamp[index(band)] = milliamp;
        for (proc::WarmUpPoint& point : *points)
            point.current = milliamp > 0 ? point.current / milliamp : 1;
        const auto fit = proc::fitWarmUp(*points);
        if (!fit) return fit.error().in("band " + std::string(letter(band)));
        monitor.bands[index(band)] = *fit;
    }
    return monitor;
}

}  // namespace

int sensorSteps() { return 3 * kExposures; }
int warmUpSteps() { return static_cast<int>(kBands.size()) * kCycles * (2 + 2 * kWarmSteps); }

Result<SensorRecord> measureSensor(const Bench& bench) {
    return thenDark(bench, takeSensor(bench));
}

Result<proc::LedMonitor> measureWarmUp(const Bench& bench) {
    return thenDark(bench, takeWarmUp(bench));
}

RigProfile withSensor(RigProfile profile, const SensorRecord& sensor, std::int64_t id) {
    profile.noise.electronsPerDn = sensor.transfer.electronsPerDn;
    profile.noise.readNoiseElectrons = sensor.transfer.readNoiseElectrons;
    profile.response = sensor.linearity.linearity;
    profile.linearity = sensor.linearity.largestResidualDn / sensor.linearity.linearity.rangeDn;
    profile.hash += "/" + std::to_string(id);
    return profile;
}

}  // namespace gonio::daemon
