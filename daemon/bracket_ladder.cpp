#include "daemon/bracket_ladder.h"

#include <algorithm>

namespace gonio::daemon {
namespace {

// The field of view is a disc in a square window: 74 % of its pixels. When nearly all of them are
// saturated, a longer exposure tells nothing new.
constexpr double kDiscShare = 0.70;

std::uint32_t mostSaturated(std::span<const Frame> frames) {
    std::uint32_t most = 0;
    for (const Frame& frame : frames) most = std::max(most, frame.saturatedPixels);
    return most;
}

}  // namespace

BracketLadder::BracketLadder(const RigProfile& profile, const BracketPlan& plan)
    : fullScale_(profile.noise.fullScaleDn) {
    const auto& ladder = profile.exposures;
    const int last = static_cast<int>(ladder.size()) - 1;
    const int longest = plan.longest < 0 ? last : std::min(plan.longest, last);
    const int first = std::clamp(plan.first, 0, longest);
    const auto rung = [&](int i) { return Shot{.exposure = ladder[static_cast<std::size_t>(i)]}; };
    first_.shots = {rung(first)};
    for (int i = first - 1; i >= 0; --i) down_.shots.push_back(rung(i));
    if (plan.dim) {
        for (double level : profile.dimLevels) down_.shots.push_back({level, ladder.front()});
    }
    for (int i = first + 1; i <= longest; ++i) up_.shots.push_back(rung(i));
}

bool BracketLadder::onTheWay(Way way) const {
    return std::find(onTheWay_.begin(), onTheWay_.end(), way) != onTheWay_.end();
}

NextShot BracketLadder::begin(Chain& chain, Way way) {
    onTheWay_.push_back(way);
    return {.outlook = Outlook::Shot, .shot = chain.shots[chain.begun++]};
}

NextShot BracketLadder::advance() {
    if (first_.more()) return begin(first_, Way::First);
    if (onTheWay(Way::First)) {
        // Nothing is known yet; what is safe for white leaves something to a longer exposure.
        const bool more = up_.more() && !onTheWay(Way::Up);
        return more ? begin(up_, Way::Up) : NextShot{.outlook = Outlook::Unknown};
    }
    const bool awaitsDown = onTheWay(Way::Down);
    if (down_.more() && down_.saturated > 0 && !awaitsDown) return begin(down_, Way::Down);
    const std::uint32_t saturated = onTheWay(Way::Up) ? foreseen_ : up_.saturated;
    if (up_.more() && saturated < everything_) return begin(up_, Way::Up);
    return {.outlook = down_.more() && awaitsDown ? Outlook::Unknown : Outlook::Over};
}

void BracketLadder::seen(std::span<const Frame> frames) {
    const Way way = onTheWay_.front();
    onTheWay_.pop_front();
    const std::uint32_t saturated = mostSaturated(frames);
    if (way == Way::First) {
        everything_ = static_cast<std::uint32_t>(
            kDiscShare * static_cast<double>(frames.front().pixels.size().pixels()));
    }
    if (way != Way::Up) down_.saturated = saturated;
    if (way == Way::Down) return;
    up_.saturated = saturated;
    foreseen_ = foresee(frames.front());
}

/// Pixels of the next shot up that will be saturated, if this is the shot before it. What the
/// sensor adds to each exposure that it grants is taken to be the same.
std::uint32_t BracketLadder::foresee(const Frame& frame) const {
    const std::size_t taken = up_.begun - (onTheWay(Way::Up) ? 1 : 0);
    if (taken >= up_.shots.size()) return 0;
    const Nanoseconds granted = frame.exposure.granted;
    const Nanoseconds longer =
        granted + Nanoseconds(up_.shots[taken].exposure - frame.exposure.requested);
    const double ratio = Seconds(longer) / Seconds(granted);
    const double enough = frame.blackLevel + (fullScale_ - frame.blackLevel) / ratio;
    const auto& pixels = frame.pixels.pixels();
    return static_cast<std::uint32_t>(
        std::count_if(pixels.begin(), pixels.end(), [=](auto dn) { return dn >= enough; }));
}

}  // namespace gonio::daemon
