#pragma once
// Which captures a bracket needs (pure: no device). It begins at an exposure that is safe for
// white. While anything is saturated it goes down: to shorter exposures, then dimmer LEDs. Until
// everything is saturated it goes up: to longer ones. One shot may be on its way while the next is
// chosen, so that exposures overlap transfers; down and up take turns where both are needed, which
// mostly leaves nothing to guess. Only on the way up is a result foreseen: pixels of the last
// picture, scaled to the longer exposure. A wrong guess costs one shot more than needed, in which
// everything is saturated, or one that is taken serially. The shots depend on the frames alone.

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "daemon/profile.h"
#include "proc/core/frame.h"

namespace gonio::daemon {

/// How many frames a bracket takes of each exposure, and how far it reaches.
struct BracketPlan {
    int frames = 1;
    bool dim = true;   ///< use dimmer LED levels where the shortest exposure saturates
    int longest = -1;  ///< index of the longest exposure of the ladder; -1: the last
    int first = 1;     ///< index of the exposure to begin with
};

struct Shot {
    double level = 1;  ///< of the LED, fraction of full
    Microseconds exposure{0};
    bool operator==(const Shot&) const = default;
};

/// Decided; to be decided by the shot that is on its way; or no more needed, as far as is foreseen.
enum class Outlook {
    Shot,
    Unknown,
    Over
};
struct NextShot {
    Outlook outlook = Outlook::Over;
    Shot shot{};
};

class BracketLadder {
public:
    BracketLadder(const RigProfile& profile, const BracketPlan& plan);

    /// The next shot, which is on its way from now on; with nothing on its way never Unknown, and
    /// Over is certain.
    NextShot advance();
    /// The frames of the oldest shot that is on its way.
    void seen(std::span<const Frame> frames);

private:
    enum class Way {
        First,
        Down,
        Up
    };
    /// Shots in order, and how many of them are on their way or taken.
    struct Chain {
        std::vector<Shot> shots;
        std::size_t begun = 0;
        std::uint32_t saturated = 0;  ///< pixels in the last picture that was seen
        [[nodiscard]] bool more() const { return begun < shots.size(); }
    };

    NextShot begin(Chain& chain, Way way);
    [[nodiscard]] bool onTheWay(Way way) const;
    [[nodiscard]] std::uint32_t foresee(const Frame& frame) const;

    double fullScale_;
    Chain first_, down_, up_;
    std::uint32_t foreseen_ = 0;  ///< saturated pixels of the next shot up after the last one seen
    std::uint32_t everything_ = 0;
    std::deque<Way> onTheWay_;  ///< oldest first
};

}  // namespace gonio::daemon
