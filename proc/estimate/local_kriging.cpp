#include "proc/estimate/local_kriging.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <numeric>

#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Index = Eigen::Index;

Place3 placeOf(const Eigen::Vector3d& at) { return {at.x(), at.y(), at.z()}; }

/// One in eight of what it is asked with different numbers [Steele2014: splitmix64].
bool drawn(std::uint64_t number) {
    number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9ULL;
    number = (number ^ (number >> 27)) * 0x94d049bb133111ebULL;
    return ((number ^ (number >> 31)) >> 61) == 0;
}

}  // namespace

LocalKriging::LocalKriging(const KrigingProcess& process,
                           std::vector<KrigingPlace> places,
                           VectorXd values,
                           std::size_t neighbours)
    : noise_(process.noise),
      neighbours_(neighbours),
      places_(std::move(places)),
      values_(std::move(values)) {
    std::vector<std::uint32_t> samples(places_.size());
    std::iota(samples.begin(), samples.end(), 0U);
    levels_.push_back(levelOf(samples));
    while (samples.size() > neighbours_) {
        const std::uint64_t turn = levels_.size() << 32U;
        std::erase_if(samples, [&](std::uint32_t i) {
            return !drawn((turn + i + 1) * 0x9e3779b97f4a7c15ULL);
        });
        levels_.push_back(levelOf(samples));
    }
    if (places_.size() > kMostKept) return;
    kept_.resize(places_.size());
    parallelFor(kept_.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) kept_[i] = neighbourhoodOf(i);
    });
}

LocalKriging::Level LocalKriging::levelOf(std::vector<std::uint32_t> samples) const {
    std::vector<Place3> ways;  // straight at 2 i, exchanged at 2 i + 1
    ways.reserve(2 * samples.size());
    for (const std::uint32_t i : samples) {
        ways.push_back(placeOf(places_[i].straight));
        ways.push_back(placeOf(places_[i].exchanged));
    }
    return {std::move(samples), PlaceTree(std::move(ways))};
}

std::vector<std::uint32_t> LocalKriging::nearest(const KrigingPlace& here,
                                                 std::size_t count) const {
    return nearestIn(levels_.front(), here, count);
}

std::vector<std::uint32_t> LocalKriging::nearestIn(const Level& level,
                                                   const KrigingPlace& here,
                                                   std::size_t count) {
    // A sample stands in the tree twice.
    std::vector<NearPosition> found = level.tree.nearest(placeOf(here.straight), 2 * count);
    for (const NearPosition& one : level.tree.nearest(placeOf(here.exchanged), 2 * count)) {
        found.push_back(one);
    }
    for (NearPosition& one : found) one.position = level.samples[one.position / 2];
    // The nearer way of each.
    std::sort(found.begin(), found.end(), [](const NearPosition& a, const NearPosition& b) {
        return a.position != b.position ? a.position < b.position : a < b;
    });
    const auto same = [](const NearPosition& a, const NearPosition& b) {
        return a.position == b.position;
    };
    found.erase(std::unique(found.begin(), found.end(), same), found.end());
    std::sort(found.begin(), found.end());
    found.resize(std::min(found.size(), count));
    std::vector<std::uint32_t> positions;
    for (const NearPosition& one : found) positions.push_back(one.position);
    return positions;
}

std::vector<std::uint32_t> LocalKriging::neighboursOf(std::size_t sample) const {
    const KrigingPlace& here = places_[sample];
    if (levels_.size() == 1) return nearest(here, neighbours_);
    std::vector<std::uint32_t> all = nearest(here, (neighbours_ + 1) / 2);
    for (std::size_t level = 1; level < levels_.size(); ++level) {
        const std::size_t share = (neighbours_ - all.size()) / (levels_.size() - level);
        // As many are new, with those that are in already.
        const auto more = nearestIn(levels_[level], here, all.size() + share);
        const std::size_t full = all.size() + share;
        for (const std::uint32_t one : more) {
            if (all.size() == full) break;
            if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
        }
    }
    return all;
}

std::vector<std::uint32_t> LocalKriging::nearestByBruteForce(const KrigingPlace& here,
                                                             std::size_t count) const {
    std::vector<NearPosition> all;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& own : {here.straight, here.exchanged}) {
            for (const auto& other : {places_[i].straight, places_[i].exchanged}) {
                least = std::min(least, squaredDistance(placeOf(own), placeOf(other)));
            }
        }
        all.push_back({least, static_cast<std::uint32_t>(i)});
    }
    std::sort(all.begin(), all.end());
    all.resize(std::min(all.size(), count));
    std::vector<std::uint32_t> positions;
    for (const NearPosition& one : all) positions.push_back(one.position);
    return positions;
}

LocalKriging::Neighbourhood LocalKriging::neighbourhoodOf(std::size_t sample) const {
    Neighbourhood made{.samples = neighboursOf(sample), .weights = {}, .factor = {}};
    std::vector<KrigingPlace> at;
    VectorXd y(static_cast<Index>(made.samples.size()));
    for (std::size_t i = 0; i < made.samples.size(); ++i) {
        at.push_back(places_[made.samples[i]]);
        y(static_cast<Index>(i)) = values_(made.samples[i]);
    }
    MatrixXd matrix = correlations(at);
    matrix.diagonal().array() += noise_;
    const Eigen::LLT<MatrixXd> factor(matrix);
    made.weights = factor.solve(y);
    const MatrixXd lower = factor.matrixL();
    made.factor.reserve(static_cast<std::size_t>(y.size() * (y.size() + 1) / 2));
    for (Index row = 0; row < y.size(); ++row) {
        for (Index column = 0; column <= row; ++column) made.factor.push_back(lower(row, column));
    }
    return made;
}

Kriged LocalKriging::at(const KrigingPlace& here, std::size_t nearest) const {
    if (kept_.empty()) return kriged(here, neighbourhoodOf(nearest));
    return kriged(here, kept_[nearest]);
}

Kriged LocalKriging::kriged(const KrigingPlace& here, const Neighbourhood& from) const {
    const Index count = from.weights.size();
    VectorXd alike(count);
    for (Index i = 0; i < count; ++i) {
        alike(i) = correlation(here, places_[from.samples[static_cast<std::size_t>(i)]]);
    }
    // L^-1 alike, row by row.
    VectorXd solved(count);
    const double* row = from.factor.data();
    for (Index i = 0; i < count; ++i) {
        const double known = Eigen::Map<const VectorXd>(row, i).dot(solved.head(i));
        solved(i) = (alike(i) - known) / row[i];
        row += i + 1;
    }
    return {alike.dot(from.weights), std::max(0.0, 1 - solved.squaredNorm())};
}

}  // namespace gonio::proc
