#include "proc/plan/rig_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kMostLevels = 8;
constexpr std::size_t kMostExposures = 12;
constexpr double kFullWellShare = 0.95;  // as far as the mask of saturation.h goes
constexpr double kLongestExposure = 3600;

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Usage, .message = "plan: rig: " + what};
}

bool positive(double value) { return std::isfinite(value) && value > 0; }
bool notNegative(double value) { return std::isfinite(value) && value >= 0; }

Nanoseconds rounded(Seconds time) { return std::chrono::round<Nanoseconds>(time); }

/// Empty: the sensor can be planned with.
std::string whatIsWrong(const SensorModel& sensor) {
    const SensorNoise& noise = sensor.noise;
    if (!positive(noise.electronsPerDn)) return "electrons per DN must be above 0";
    if (!notNegative(noise.readNoiseElectrons)) return "read noise must not be negative";
    if (!notNegative(noise.darkElectronsPerSecond)) return "dark current must not be negative";
    if (!notNegative(sensor.blackDn) || !(sensor.blackDn < noise.saturationDn()))
        return "the black level must lie below saturation";
    if (!positive(sensor.fullWellElectrons)) return "the full well must be above 0";
    if (!std::isfinite(sensor.celsius) || !positive(sensor.darkDoublingKelvin))
        return "the sensor's temperature must be finite, and its dark current double in above 0 K";
    if (!positive(sensor.headroom) || sensor.headroom > 1) return "headroom must be in (0, 1]";
    return {};
}

std::string whatIsWrong(const RigTiming& timing) {
    if (!positive(timing.framePeriod.count())) return "the frame period must be above 0";
    for (const Seconds part :
         {timing.readout, timing.handover, timing.ledSettle, timing.transfer, timing.planning}) {
        if (!notNegative(part.count())) return "no time may be negative";
    }
    if (timing.transfer > timing.framePeriod)
        return "a picture's transfer must not take longer than the frame period";
    return {};
}

std::string whatIsWrong(const std::vector<double>& levels) {
    const auto inside = [](double level) { return level > 0 && level <= 1; };
    const auto rises = [](double a, double b) { return !(a > b); };
    if (levels.empty() || levels.size() > kMostLevels)
        return "1.." + std::to_string(kMostLevels) + " LED levels are wanted, saw " +
               std::to_string(levels.size());
    if (!std::all_of(levels.begin(), levels.end(), inside)) return "LED levels lie in (0, 1]";
    if (std::adjacent_find(levels.begin(), levels.end(), rises) != levels.end())
        return "LED levels must descend";
    return {};
}

std::string whatIsWrong(const std::vector<Seconds>& exposures) {
    const auto inside = [](Seconds e) {
        return positive(e.count()) && e.count() < kLongestExposure;
    };
    const auto falls = [](Seconds a, Seconds b) { return !(a < b); };
    if (exposures.empty() || exposures.size() > kMostExposures)
        return "1.." + std::to_string(kMostExposures) + " exposures are wanted, saw " +
               std::to_string(exposures.size());
    if (!std::all_of(exposures.begin(), exposures.end(), inside))
        return "exposures lie between 0 and " + fixed(kLongestExposure, 0) + " s";
    if (std::adjacent_find(exposures.begin(), exposures.end(), falls) != exposures.end())
        return "exposures must ascend";
    return {};
}

}  // namespace

SensorNoise SensorModel::noiseNow() const {
    SensorNoise now = noise;
    now.darkElectronsPerSecond *= std::exp2((celsius - 25) / darkDoublingKelvin);
    return now;
}

double SensorModel::usableElectrons() const {
    const double masked = (noise.saturationDn() - blackDn) * noise.electronsPerDn;
    return headroom * std::min(masked, kFullWellShare * fullWellElectrons);
}

RigTiming RigTiming::usb2() { return {}; }

RigTiming RigTiming::usb3() {
    return {
        .framePeriod = Seconds(1.0 / 60), .handover = Seconds(0.0015), .transfer = Seconds(0.004)};
}

Result<void> RigModel::check() const {
    for (const std::string& wrong :
         {whatIsWrong(sensor), whatIsWrong(timing), whatIsWrong(levels), whatIsWrong(exposures)}) {
        if (!wrong.empty()) return refused(wrong);
    }
    if (darkFramesHeld < 0) return refused("the dark frames held must not be negative");
    if (maxFrames < 1) return refused("a capture holds at least one frame");
    return {};
}

std::vector<ShotKind> RigModel::pilotShots() const {
    const auto behind = std::upper_bound(exposures.begin(), exposures.end(), longestPilot);
    const Seconds longest = behind == exposures.begin() ? exposures.front() : *std::prev(behind);
    std::vector<ShotKind> shots;
    for (const ShotKind& shot : {ShotKind{levels.back(), exposures.front()},
                                 ShotKind{levels.front(), exposures.front()},
                                 ShotKind{levels.front(), longest}}) {
        if (std::find(shots.begin(), shots.end(), shot) == shots.end()) shots.push_back(shot);
    }
    return shots;
}

Nanoseconds ShotCost::frame(Seconds exposure) const {
    return rounded(std::max(timing_.framePeriod, exposure + timing_.readout));
}

Nanoseconds ShotCost::lastFrame(Seconds exposure) const {
    return std::max(frame(exposure), rounded(exposure + timing_.handover + timing_.ledSettle));
}

Nanoseconds ShotCost::capture(Seconds exposure, int frames) const {
    if (frames <= 0) return Nanoseconds(0);
    return (frames - 1) * frame(exposure) + lastFrame(exposure);
}

Nanoseconds ShotCost::darkCapture(Seconds exposure, int frames) const {
    if (frames <= 0) return Nanoseconds(0);
    const Nanoseconds last = std::max(frame(exposure), rounded(exposure + timing_.handover));
    return (frames - 1) * frame(exposure) + last;
}

}  // namespace gonio::proc
