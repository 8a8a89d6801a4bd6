#include "daemon/sequencer.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gonio::daemon {
namespace {

constexpr double kFullLevel = 65535;
// The field of view is a disc in a square window: 74 % of its pixels. When nearly all of them are
// saturated, a longer exposure tells nothing new.
constexpr double kDiscShare = 0.70;

std::uint32_t mostSaturated(const std::vector<Frame>& frames) {
    std::uint32_t most = 0;
    for (const Frame& frame : frames) most = std::max(most, frame.saturatedPixels);
    return most;
}

}  // namespace

BracketPlan sampleBracket(Effort effort) {
    switch (effort) {
        case Effort::Draft: return {.frames = 1, .longest = 4};
        case Effort::Standard: return {.frames = 1};
        case Effort::Reference: return {.frames = 8};
    }
    return {};
}

Sequencer::Sequencer(driver::Rig& rig, const RigProfile& profile, std::uint64_t& nextPlanStep)
    : rig_(rig),
      profile_(profile),
      nextPlanStep_(nextPlanStep),
      leds_(static_cast<int>(rig.identify().ledAngles.size())) {}

std::vector<State> Sequencer::states() const {
    std::vector<State> all;
    for (int led = 0; led < leds_; ++led) {
        for (Band band : kBands) all.push_back({led, band});
    }
    return all;
}

Result<std::vector<Frame>> Sequencer::expose(State state,
                                             double level,
                                             Microseconds exposure,
                                             int frames) {
    const auto drive = static_cast<std::uint16_t>(std::lround(level * kFullLevel));
    Result<driver::Capture> capture =
        rig_.capture({.planStep = nextPlanStep_++,
                      .led = state.led,
                      .levels = LedLevels::only(state.band, std::max<std::uint16_t>(1, drive)),
                      .exposure = exposure,
                      .frames = frames});
    if (!capture) return capture.error();
    return std::move(capture->frames);
}

Result<std::vector<Frame>> Sequencer::bracket(State state, const BracketPlan& plan) {
    std::vector<Frame> all;
    std::uint32_t saturated = 0;
    const auto take = [&](double level, Microseconds exposure) -> Result<void> {
        Result<std::vector<Frame>> frames = expose(state, level, exposure, plan.frames);
        if (!frames) return frames.error();
        saturated = mostSaturated(*frames);
        std::move(frames->begin(), frames->end(), std::back_inserter(all));
        return {};
    };
    const auto& ladder = profile_.exposures;
    const int last = static_cast<int>(ladder.size()) - 1;
    const int longest = plan.longest < 0 ? last : std::min(plan.longest, last);
    const int first = std::clamp(plan.first, 0, longest);
    const auto rung = [&](int i) { return ladder[static_cast<std::size_t>(i)]; };

    if (Result<void> taken = take(1, rung(first)); !taken) return taken.error();
    const std::uint32_t saturatedAtFirst = saturated;
    for (int i = first - 1; i >= 0 && saturated > 0; --i) {
        if (Result<void> taken = take(1, rung(i)); !taken) return taken.error();
    }
    for (std::size_t i = 0; plan.dim && i < profile_.dimLevels.size() && saturated > 0; ++i) {
        if (Result<void> taken = take(profile_.dimLevels[i], rung(0)); !taken) return taken.error();
    }
    const double everything = kDiscShare * static_cast<double>(all.front().pixels.size().pixels());
    saturated = saturatedAtFirst;
    for (int i = first + 1; i <= longest && saturated < everything; ++i) {
        if (Result<void> taken = take(1, rung(i)); !taken) return taken.error();
    }
    return all;
}

Result<std::vector<proc::DarkFrame>> Sequencer::darks(int frames,
                                                      const std::function<Result<void>()>& done) {
    std::vector<proc::DarkFrame> darks;
    for (Microseconds exposure : profile_.exposures) {
        const auto taken = rig_.capture({.planStep = nextPlanStep_++,
                                         .led = std::nullopt,
                                         .levels = {},
                                         .exposure = exposure,
                                         .frames = frames});
        if (!taken) return taken.error();
        Result<proc::DarkFrame> dark = proc::averageDark(taken->frames, profile_.noise);
        if (!dark) return dark.error();
        darks.push_back(std::move(*dark));
        if (Result<void> on = done(); !on) return on.error();
    }
    return darks;
}

}  // namespace gonio::daemon
