#pragma once
// Kriging from the samples about a place: those of the sample that is nearest to it. What they
// weigh is worked out once for each sample and kept where the samples are few; an answer is then a
// search and a product of some thousand numbers.
//
// Half of a sample's neighbours are the nearest of all, the others the nearest of random subsets of
// an eighth, a 64th ... of them: samples that stand dense at a few incidences would have none of
// another incidence among their nearest.
//
// Two pairs are as far apart as their places are in the process's coordinates, light and view of
// either exchanged or not, whichever is less.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "proc/estimate/kriging_process.h"
#include "proc/table/place_tree.h"

namespace gonio::proc {

/// Of the value at a place.
struct Kriged {
    double value = 0;
    double unknown = 1;  ///< share of the process's variance that the samples leave open
};

class LocalKriging {
public:
    /// Samples up to this number have their neighbourhoods kept: 26 kB each of 80 neighbours.
    static constexpr std::size_t kMostKept = 2048;

    LocalKriging() = default;
    /// At least one sample; a value for each place. On all cores.
    LocalKriging(const KrigingProcess& process,
                 std::vector<KrigingPlace> places,
                 Eigen::VectorXd values,
                 std::size_t neighbours);

    /// Positions of the samples about a place, the nearest first.
    [[nodiscard]] std::vector<std::uint32_t> nearest(const KrigingPlace& here,
                                                     std::size_t count) const;
    /// The same by a walk over all samples: the slow twin.
    [[nodiscard]] std::vector<std::uint32_t> nearestByBruteForce(const KrigingPlace& here,
                                                                 std::size_t count) const;

    /// Out of the neighbourhood of the sample at position `nearest`.
    [[nodiscard]] Kriged at(const KrigingPlace& here, std::size_t nearest) const;

private:
    /// Some of the samples, in a tree of both ways of each place.
    struct Level {
        std::vector<std::uint32_t> samples;
        PlaceTree tree;
    };
    struct Neighbourhood {
        std::vector<std::uint32_t> samples;
        Eigen::VectorXd weights;     ///< K^-1 times the values
        std::vector<double> factor;  ///< of K = L L^T, the rows of L one after the other
    };
    [[nodiscard]] Level levelOf(std::vector<std::uint32_t> samples) const;
    [[nodiscard]] static std::vector<std::uint32_t> nearestIn(const Level& level,
                                                              const KrigingPlace& here,
                                                              std::size_t count);
    [[nodiscard]] std::vector<std::uint32_t> neighboursOf(std::size_t sample) const;
    [[nodiscard]] Neighbourhood neighbourhoodOf(std::size_t sample) const;
    [[nodiscard]] Kriged kriged(const KrigingPlace& here, const Neighbourhood& from) const;

    double noise_ = 0;
    std::size_t neighbours_ = 0;
    std::vector<KrigingPlace> places_;
    Eigen::VectorXd values_;
    std::vector<Level> levels_;  ///< the first holds all samples
    std::vector<Neighbourhood> kept_;
};

}  // namespace gonio::proc
