#pragma once
// A second bound on what is left of a partial cover, in whole frames. Shot noise alone cannot be
// undercut: n frames of effective time tau tell at most n tau / x about a pixel of rate x. So a
// need q is met only when all frames that its pixel sees together have the effective time x q.
// In this relaxed problem a partial answer is one number, its effective time, and the least cost of
// the rest is a falling staircase over that number, computed from the last shot backwards. It knows
// what cover_bound.h does not, that frames are whole; that one knows read noise and dark current.

#include <vector>

#include "proc/plan/cover.h"

namespace gonio::proc {

class LightBound {
public:
    /// `order`: indices of the shots by falling reach. `due`: of each need, how many shots of that
    /// order see its pixel. Costs above `most` are not told apart.
    LightBound(const CoverProblem& problem,
               const std::vector<std::size_t>& order,
               const std::vector<std::size_t>& due,
               Nanoseconds most);

    /// The least cost of the shots from the k-th of the order on, when those before together have
    /// this effective time: at most `most`.
    [[nodiscard]] Nanoseconds from(std::size_t k, double effectiveSeconds) const;

private:
    /// With at least this effective time the rest costs this much.
    struct Step {
        double effective = 0;
        Nanoseconds cost{0};
    };
    using Stairs = std::vector<Step>;  ///< effective time falls, cost rises

    [[nodiscard]] static Stairs before(
        const CoverShot& shot, double needed, const Stairs& after, Nanoseconds most, int maxFrames);

    [[nodiscard]] static Stairs lower(const Stairs& a, const Stairs& b);

    Nanoseconds most_;
    std::vector<Stairs> stairs_;  // from each shot on; the last is after all
};

}  // namespace gonio::proc
