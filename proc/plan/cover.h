#pragma once
// The cheapest captures of one state. Given the kinds of shots, what a frame of each costs, what
// has been taken already (pilots), and for some pixels the information that is needed: how many
// more frames of each shot, so that every need is met in the least time?
//
// A shot of a higher reach is seen by all pixels that one of a lower reach is seen by. So shots
// are decided from the highest reach down, and a need is due at the last shot that its pixel can
// see. Dynamic programming over the shots: a label is (time spent, information still wanted by
// each need); one that is no cheaper and nowhere further than another is dropped. Labels that
// cannot beat the best known are dropped by the prices of the relaxed problem (cover_bound.h): a
// frame cannot bring more than its time's worth at these prices. Both keep the optimum, so a
// stricter need never makes the answer cheaper.
//
// What a shot's frames tell is counted in 128ths of what the need wants, rounded down: less than 1
// % of an uncertainty is given away, and far fewer labels differ. A stricter need counts no more of
// the same frames, so this too keeps the order of the answers.
//
// Without needs, or where the pilots meet them: no frames. A need that no number of frames up to
// maxFrames can meet: no answer.

#include <optional>
#include <vector>

#include "proc/plan/information.h"

namespace gonio::proc {

struct CoverShot {
    ShotOption option;
    int have = 0;              ///< frames that are there already
    Nanoseconds frame{0};      ///< each frame but the last, > 0
    Nanoseconds lastFrame{0};  ///< at least `frame`

    [[nodiscard]] Nanoseconds cost(int more) const {
        return more <= 0 ? Nanoseconds(0) : (more - 1) * frame + lastFrame;
    }
};

struct CoverNeed {
    double rate = 0;         ///< electrons per second at full level, of one pixel
    double information = 0;  ///< wanted of one pixel
};

struct CoverProblem {
    std::vector<CoverShot> shots;
    std::vector<CoverNeed> needs;
    int maxFrames = 256;  ///< more of one shot
};

struct Cover {
    std::vector<int> more;  ///< frames of each shot, in the order of the problem's
    Nanoseconds cost{0};
};

/// What the search came to.
struct CoverAnswer {
    std::optional<Cover> cover;  ///< nothing: none costs less than the limit
    /// That this is the last word. Where more than 1000 labels stay open after one shot, the search
    /// goes on with the most promising ones, and what it finds is only as good as that.
    bool proven = true;
};
[[nodiscard]] CoverAnswer cheapestCover(const CoverProblem& problem,
                                        Nanoseconds limit = Nanoseconds::max());

/// The slow, obvious twin: tries every combination of up to maxFrames frames.
[[nodiscard]] std::optional<Cover> cheapestCoverReference(const CoverProblem& problem);

/// What n frames in all tell a need, in 128ths of what it wants, rounded down; at most 128.
inline constexpr int kNeedUnits = 128;
[[nodiscard]] int needUnits(const ShotOption& shot, const CoverNeed& need, int frames);

/// The needs without those that others imply, for these shots and any subset of them.
[[nodiscard]] std::vector<CoverNeed> essentialNeeds(const std::vector<CoverShot>& shots,
                                                    std::vector<CoverNeed> needs);

}  // namespace gonio::proc
