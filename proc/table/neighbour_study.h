#pragma once
// What nearest neighbours cost: the time to build a set, the time of a query and the bytes held,
// over the number of samples, for the tree and for the walk over all (its twin), and how each
// grows.
//
// The points are like those of a rig that measured n pairs: incidences 0, 20, 40, 60 degrees, each
// jittered by up to 10 degrees so that no two samples share one, seen in cells of CellGrid below 75
// degrees at random places within the cell; isotropic. Queries are pairs drawn the same way. f is
// of no matter here. Same seed, same points.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "proc/core/stopwatch.h"
#include "proc/table/scattered_set.h"

namespace gonio::proc {

struct NeighbourStudyOptions {
    std::vector<std::size_t> sizes{1'000, 10'000, 100'000, 1'000'000};
    std::size_t neighbours = 10;
    PairSymmetry symmetry = PairSymmetry::Isotropic;
    int repeats = 5;     ///< of each time; the median counts
    Seconds each{0.05};  ///< queries are asked for this long in each repeat, at least 8 of them
    std::uint64_t seed = 1;
};

struct NeighbourCost {
    std::size_t samples = 0;
    Seconds build{};       ///< of the whole set by one add: copies and tree
    Seconds query{};       ///< one, by the tree
    Seconds bruteForce{};  ///< one, by the walk
    std::size_t treeBytes = 0;
    std::size_t sampleBytes = 0;
};

/// The exponent of the power of the number of samples as which a value grows: the slope of the
/// straight line through (ln n, ln value) by least squares. NaN of fewer than two sizes.
using NeighbourValue = std::function<double(const NeighbourCost&)>;
[[nodiscard]] double growthOf(const std::vector<NeighbourCost>& rows, const NeighbourValue& value);

/// `count` samples at the pairs described above.
[[nodiscard]] std::vector<ScatteredSample> rigLikeSamples(std::size_t count, std::uint64_t seed);

/// Called after each size with the part done, in (0, 1].
using NeighbourProgress = std::function<void(double)>;

/// One row for each size, in their order.
[[nodiscard]] std::vector<NeighbourCost> studyNeighbours(const Stopwatch& watch,
                                                         const NeighbourStudyOptions& options,
                                                         const NeighbourProgress& progress = {});

/// Columns samples, build_seconds, query_seconds, brute_force_seconds, tree_bytes, sample_bytes.
[[nodiscard]] std::string neighbourCsv(const std::vector<NeighbourCost>& rows);

}  // namespace gonio::proc
