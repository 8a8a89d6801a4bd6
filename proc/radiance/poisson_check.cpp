#include "proc/radiance/poisson_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/radiance/group_noise.h"

namespace gonio::proc {
namespace {

/// All samples of one pixel in one.
struct Pooled {
    double electrons = 0;
    double tau = 0;
    double variance = 0;  ///< of the electrons, at the light that they say
};

class Pooling {
public:
    explicit Pooling(const BracketSums& sums) : sums_(sums), groups_(sums.groups.size()) {
        for (const GroupSums& group : sums.groups) figures_.push_back(figuresOf(group, sums));
    }

    /// Calls `with` for each pixel of the picture: where it is, and what was pooled.
    template <class With>
    void eachPixel(const With& with) {
        for (int y = 0; y < sums_.traits.size.height; ++y) {
            for (int x = 0; x < sums_.traits.size.width; ++x) {
                const auto i = static_cast<std::size_t>(x) % kBlock;
                if (i == 0) {
                    for (std::size_t g = 0; g < groups_.size(); ++g)
                        readGroup(sums_, g, {x, y}, groups_[g]);
                }
                with(x, y, pooled(i));
            }
        }
    }

private:
    [[nodiscard]] Pooled pooled(std::size_t i) const {
        Pooled sum;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            sum.electrons += groups_[g].net[i] * sums_.noise.electronsPerDn;
            sum.tau += groups_[g].count[i] * figures_[g].tau;
        }
        const double light = sum.tau > 0 ? std::max(sum.electrons / sum.tau, 0.0) : 0;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const GroupFigures& f = figures_[g];
            const double n = groups_[g].count[i];
            const double excess = groups_[g].anyHot ? groups_[g].excess[i] : 0;
            sum.variance += n * (light * f.tau / sums_.members() + f.floorVariance + excess) +
                            n * n * (f.darkVariance + excess * f.excessInDark);
        }
        return sum;
    }

    const BracketSums& sums_;
    std::vector<GroupFigures> figures_;
    std::vector<GroupBlock> groups_;
};

}  // namespace

PoissonCheck poissonCheck(const BracketSums& sums, const MergedState& state) {
    PoissonCheck check;
    double variance = 0;
    Pooling(sums).eachPixel([&](int x, int y, const Pooled& pooled) {
        if (pooled.tau == 0) return;
        check.electrons += pooled.electrons;
        check.difference +=
            static_cast<double>(state.radiance.at(x, y)) * pooled.tau - pooled.electrons;
        const double merged = static_cast<double>(state.variance.at(x, y));
        variance += std::max(pooled.variance - merged * pooled.tau * pooled.tau, 0.0);
    });
    check.u = std::sqrt(variance);
    return check;
}

Image<float> poissonSum(const BracketSums& sums) {
    Image<float> picture(sums.traits.size, std::numeric_limits<float>::quiet_NaN());
    Pooling(sums).eachPixel([&](int x, int y, const Pooled& pooled) {
        if (pooled.tau > 0) picture.at(x, y) = static_cast<float>(pooled.electrons / pooled.tau);
    });
    return picture;
}

}  // namespace gonio::proc
