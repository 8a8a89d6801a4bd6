#include "proc/table/pair_tree.h"

#include <nanoflann.hpp>
#include <utility>

namespace gonio::proc {
namespace {

/// The tree sums squares along its way down, in another order than a distance is summed: what is
/// nearer than the rounding of that is not left out. The largest squared distance is 8.
constexpr double kRounding = 1e-14;
constexpr std::size_t kPointsPerLeaf = 10;

/// The points as the tree reads them.
struct Points {
    std::vector<LightView> pairs;
    std::vector<PairPlace> places;
    PairSymmetry symmetry;

    Points(std::vector<LightView> given, PairSymmetry by) : pairs(std::move(given)), symmetry(by) {
        places.reserve(pairs.size());
        for (const LightView& pair : pairs) places.push_back(placeOf(pair, symmetry));
    }

    // The names are nanoflann's.
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return places.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t point, std::size_t axis) const {
        return places[point][axis];
    }
    template <class Box>
    bool kdtree_get_bbox(Box& /*unused*/) const {
        return false;
    }
};

/// Branches are compared by places, points by the number that the caller works out: see Found.
struct PlaceMetric {
    using ElementType = double;
    using DistanceType = double;

    explicit PlaceMetric(const Points& points) : points_(&points) {}

    [[nodiscard]] double evalMetric(const double* at, std::uint32_t point, std::size_t axes) const {
        double sum = 0;
        for (std::size_t axis = 0; axis < axes; ++axis) {
            const double step = at[axis] - points_->places[point][axis];
            sum += step * step;
        }
        return sum;
    }
    [[nodiscard]] static double accum_dist(double a, double b, std::size_t /*axis*/) {
        return (a - b) * (a - b);
    }

private:
    const Points* points_;
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<PlaceMetric, Points, 6, std::uint32_t>;

/// nanoflann's result set. It is shown what lies near by place, and measures how far that is.
class Found {
public:
    Found(const Points& points,
          const LightView& at,
          const std::vector<unsigned char>& live,
          NearestList list)
        : points_(points), at_(at), live_(live), list_(std::move(list)) {}

    bool addPoint(double /*byPlace*/, std::uint32_t point) {
        if (live_[point] != 0) {
            list_.offer({squaredDistance(at_, points_.pairs[point], points_.symmetry), point});
        }
        return true;
    }
    [[nodiscard]] double worstDist() const { return list_.reach() + kRounding; }
    [[nodiscard]] static bool full() { return true; }
    [[nodiscard]] NearestList list() && { return std::move(list_); }

private:
    const Points& points_;
    const LightView& at_;
    const std::vector<unsigned char>& live_;
    NearestList list_;
};

}  // namespace

struct PairTree::Index {
    Points points;
    Tree tree;

    Index(std::vector<LightView> pairs, PairSymmetry symmetry)
        : points(std::move(pairs), symmetry),
          tree(6, points, nanoflann::KDTreeSingleIndexAdaptorParams(kPointsPerLeaf)) {}
};

PairTree::PairTree(std::vector<LightView> pairs, PairSymmetry symmetry)
    : index_(std::make_unique<const Index>(std::move(pairs), symmetry)) {}

PairTree::~PairTree() = default;

NearestList PairTree::search(const LightView& at,
                             const std::vector<unsigned char>& live,
                             NearestList found) const {
    if (found.reach() < 0) return found;
    const Points& points = index_->points;
    const PairPlace place = placeOf(at, points.symmetry);
    Found result(points, at, live, std::move(found));
    index_->tree.findNeighbors(result, place.data(), nanoflann::SearchParams());
    return std::move(result).list();
}

std::size_t PairTree::bytes() const {
    const auto& [points, tree] = *index_;
    return points.pairs.capacity() * sizeof(LightView) +
           points.places.capacity() * sizeof(PairPlace) +
           tree.vAcc.capacity() * sizeof(std::uint32_t) + tree.pool.usedMemory +
           tree.pool.wastedMemory;
}

}  // namespace gonio::proc
