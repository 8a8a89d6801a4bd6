#include "proc/table/place_tree.h"

#include <algorithm>
#include <limits>
#include <nanoflann.hpp>
#include <utility>

namespace gonio::proc {
namespace {

constexpr std::size_t kPointsPerLeaf = 10;

/// The points as the tree reads them; the names are nanoflann's.
struct Places {
    std::vector<Place3> at;

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return at.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t point, std::size_t axis) const {
        return at[point][axis];
    }
    template <class Box>
    bool kdtree_get_bbox(Box& /*unused*/) const {
        return false;
    }
};

struct Metric {
    using ElementType = double;
    using DistanceType = double;

    explicit Metric(const Places& places) : places_(&places) {}

    [[nodiscard]] double evalMetric(const double* at,
                                    std::uint32_t point,
                                    std::size_t /*axes*/) const {
        return squaredDistance({at[0], at[1], at[2]}, places_->at[point]);
    }
    [[nodiscard]] static double accum_dist(double a, double b, std::size_t /*axis*/) {
        return (a - b) * (a - b);
    }

private:
    const Places* places_;
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Places, 3, std::uint32_t>;

/// nanoflann's result set.
class Found {
public:
    Found(std::size_t count, double rounding)
        : list_({count, std::numeric_limits<double>::infinity()}), rounding_(rounding) {}

    bool addPoint(double squared, std::uint32_t point) {
        list_.offer({squared, point});
        return true;
    }
    [[nodiscard]] double worstDist() const { return list_.reach() + rounding_; }
    [[nodiscard]] static bool full() { return true; }
    [[nodiscard]] std::vector<NearPosition> sorted() && { return std::move(list_).sorted(); }

private:
    NearestList list_;
    double rounding_;
};

/// The tree sums squares along its way down, in another order than a distance is summed: what is
/// nearer than the rounding of that is not left out.
constexpr double kRounding = 1e-14;

}  // namespace

double squaredDistance(const Place3& a, const Place3& b) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    return sum;
}

struct PlaceTree::Index {
    Places places;
    Tree tree;
    double farthest = 0;  ///< squared, from the origin

    explicit Index(std::vector<Place3> at)
        : places{std::move(at)},
          tree(3, places, nanoflann::KDTreeSingleIndexAdaptorParams(kPointsPerLeaf)) {
        for (const Place3& place : places.at) {
            farthest = std::max(farthest, squaredDistance(place, {}));
        }
    }
};

PlaceTree::PlaceTree(std::vector<Place3> places) {
    if (!places.empty()) index_ = std::make_unique<const Index>(std::move(places));
}

PlaceTree::~PlaceTree() = default;
PlaceTree::PlaceTree(PlaceTree&&) noexcept = default;
PlaceTree& PlaceTree::operator=(PlaceTree&&) noexcept = default;

std::vector<NearPosition> PlaceTree::nearest(const Place3& at, std::size_t count) const {
    if (!index_ || count == 0) return {};
    const double largest = 4 * std::max(index_->farthest, squaredDistance(at, {}));
    Found found(count, kRounding * largest);
    index_->tree.findNeighbors(found, at.data(), nanoflann::SearchParams());
    return std::move(found).sorted();
}

}  // namespace gonio::proc
