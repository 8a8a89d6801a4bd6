#include "daemon/glare_views.h"

#include <algorithm>

#include "proc/core/log.h"
#include "proc/optics/glare_fit.h"

namespace gonio::daemon {
namespace {

constexpr Radians kOutOfField = 85_deg;
// Begins with what is safe for white: the spot is dimmed, its surroundings are exposed longer.
// One frame of each: the mean over 256 pixels leaves 1e-6 of the spot's light unknown.
constexpr BracketPlan kBracket{.frames = 1};

}  // namespace

GlareViews::GlareViews(const std::vector<Radians>& leds, const Bench& bench) : bench_(bench) {
    if (leds.empty()) return;
    const auto steepest = std::max_element(leds.begin(), leds.end());
    led_ = static_cast<int>(steepest - leds.begin());
    const Direction light = Direction::fromSpherical(*steepest, Radians(0));
    const auto theta = [&](const proc::Wedge& wedge) {
        return proc::mirroredBy(wedge, light).theta();
    };
    const auto wedges = proc::mirrorWedges();
    const auto byTheta = [&](const auto& a, const auto& b) { return theta(a) < theta(b); };
    const auto [nearest, farthest] = std::minmax_element(wedges.begin(), wedges.end(), byTheta);
    if (theta(*farthest) < kOutOfField) return;
    unlit_ = View{.wedge = *farthest};
    lit_ = {View{.wedge = *nearest}};
    if (*nearest != proc::Wedge{} && theta({}) < kField) lit_.push_back({.wedge = {}});
}

int GlareViews::count() const { return unlit_ ? 1 + static_cast<int>(lit_.size()) : 0; }

Result<void> GlareViews::take(const proc::Wedge& wedge,
                              Sequencer& sequencer,
                              const proc::DarkLibrary& darks) {
    std::vector<View*> wanted;
    if (unlit_) wanted.push_back(&*unlit_);
    for (View& view : lit_) wanted.push_back(&view);
    for (View* view : wanted) {
        if (view->wedge != wedge) continue;
        if (Result<void> on = bench_.step("glare LED " + std::to_string(led_)); !on) return on;
        proc::MergeAccumulator sums(Band::G, darks, bench_.profile.noise, bench_.profile.response);
        const Result<void> taken =
            sequencer.bracket({led_, Band::G},
                              kBracket,
                              {.frame = [&](const Frame& frame) { return sums.add(frame); },
                               .begin = [&]() -> Result<void> {
                                   sums.restart(Band::G);
                                   return {};
                               }});
        if (!taken) return taken;
        auto merged = proc::mergeSums(sums.sums());
        if (!merged) return merged.error();
        merged->used = {};  // the pictures stay until the lens map is there
        merged->saturated = {};
        view->merged = std::move(*merged);
    }
    return {};
}

std::optional<proc::GlareSpread> GlareViews::spread(const proc::LensMap& map) const {
    std::vector<proc::MirrorPair> pairs;
    for (const View& view : lit_) {
        if (view.merged && unlit_->merged) pairs.push_back({*view.merged, *unlit_->merged});
    }
    const auto found = proc::fitGlare(pairs, map, kField, bench_.profile.ledDrift);
    if (found) return *found;
    log::warning(found.error().message + "; glare is not taken off");
    return std::nullopt;
}

}  // namespace gonio::daemon
